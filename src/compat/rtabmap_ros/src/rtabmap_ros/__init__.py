"""The nodes of rtabmap_ros, backed by slam_lite."""
