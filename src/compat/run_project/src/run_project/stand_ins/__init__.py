"""What stands in for the terminal emulator, rviz and nodelets of a real computer while a project runs."""
