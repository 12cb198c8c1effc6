"""What the Navigator is given: transforms, odometry, sensors."""
