"""Example plugins, selected as ``base_local_planner: plugin_examples.pure_pursuit/PurePursuit``."""
