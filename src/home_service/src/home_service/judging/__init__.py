"""Whether a run did what it promised, by ground truth. No ROS."""
