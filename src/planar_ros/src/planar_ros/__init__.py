"""ROS side of the pure packages: messages, transforms, parameters, node start-up, lock-step, bags."""
