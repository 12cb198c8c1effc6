"""Topics of a Kobuki base, below mobile_base (kobuki_gazebo_plugins)."""
