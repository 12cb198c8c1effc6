"""The programs and services of gazebo_ros, backed by sim_bridge."""
