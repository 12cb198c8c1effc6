"""A Kobuki base below mobile_base: what it feels and what it is told (kobuki_gazebo_plugins)."""
