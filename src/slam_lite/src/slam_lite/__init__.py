"""slam_lite: graph SLAM for planar laser scanners, a stand-in for gmapping."""
