"""TITLE: a scan matcher for slam_lite."""

from slam_lite.config import MapperSettings
from slam_lite.matching.local_map import LocalMap, Match
from slam_lite.matching.refinement import refine
from slam_lite.matching.scan_matcher import Prediction
from slam_lite.point_cloud import PointCloud


class CLASS:
    """Refines the pose predicted by odometry by point-to-line matching, without a search."""

    def __init__(self, settings: MapperSettings):
        pass

    def match(self, cloud: PointCloud, local_map: LocalMap, prediction: Prediction) -> Match:
        """See slam_lite.matching.scan_matcher.ScanMatcher; the arguments are read-only."""
        predicted = prediction.base_pose
        return refine(cloud, local_map, predicted, predicted, prediction.information)
