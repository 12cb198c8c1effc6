"""What tools compute and show, without ROS and without a page."""
