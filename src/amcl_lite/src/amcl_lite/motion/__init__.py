"""Motion models, and the update condition by the motion of the odometry."""
