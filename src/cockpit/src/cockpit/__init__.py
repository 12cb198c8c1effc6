"""A cockpit in the browser: what rviz, Gazebo's window and rqt show, in one page."""
