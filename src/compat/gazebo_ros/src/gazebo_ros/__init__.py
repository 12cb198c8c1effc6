"""What launch files and scripts find in gazebo_ros, for sim_bridge."""
