"""Deprecated names of ``slam_lite.point_cloud``."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(
    __name__,
    {
        "Surface": "slam_lite.point_cloud:PointCloud",
        "surface_of": "slam_lite.point_cloud:point_cloud_of",
        "joined": "slam_lite.point_cloud:merge_clouds",
        "thinned": "slam_lite.point_cloud:downsampled",
        "filled": "slam_lite.point_cloud:interpolated",
    },
)
