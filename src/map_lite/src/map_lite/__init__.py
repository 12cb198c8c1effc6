"""Serves and saves maps; the nodes are in ``map_server_node`` and ``map_saver_node``."""
