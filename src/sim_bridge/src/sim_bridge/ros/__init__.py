"""The parts of sim_bridge's node: each translates one side of a Scene to ROS."""
