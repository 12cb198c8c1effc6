"""Between ROS and the pure packages: messages to planar types, parameters to settings, transforms, node manners."""
