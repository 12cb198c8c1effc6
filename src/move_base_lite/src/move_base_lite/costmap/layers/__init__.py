"""The layers of a costmap, one a module."""
