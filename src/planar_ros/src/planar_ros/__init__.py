"""Between ROS and the pure packages: messages to types, parameters to settings, transforms, manners."""
