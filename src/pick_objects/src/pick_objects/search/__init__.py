"""Object search: where to look next, given what is usually where and what was seen. No ROS."""

from pick_objects.search.area import SearchArea, search_area_of
from pick_objects.search.execution import (
    LookForObject,
    LookTaken,
    ObjectFound,
    ObjectNotFound,
    SearchExecution,
)
from pick_objects.search.object_search import ObjectSearch

__all__ = [
    "LookForObject",
    "LookTaken",
    "ObjectFound",
    "ObjectNotFound",
    "ObjectSearch",
    "SearchArea",
    "SearchExecution",
    "search_area_of",
]
