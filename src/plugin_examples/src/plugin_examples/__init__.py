"""Plugins to begin with; ``base_local_planner: plugin_examples.pure_pursuit/PurePursuit`` chooses one."""
