"""Map server and map saver; the nodes are in ``map_lite.ros``."""
