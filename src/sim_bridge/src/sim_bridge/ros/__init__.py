"""ROS interface of the simulation: topics, services, parameters and time of a Scene."""
