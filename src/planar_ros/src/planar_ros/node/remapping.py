"""Names of topics, remapped as by roscpp."""

from typing import List

import rospy


def remap_once(*names: str) -> List[str]:
    """The full names of topics, to be opened by these.

    rospy remaps a name once more where it opens the topic: with ``odom:=wheel_odom odom_faulty:=odom`` what
    is published on odom_faulty would come back on wheel_odom.
    """
    full = [rospy.resolve_name(name) for name in names]
    for name in full:
        rospy.names.get_resolved_mappings().pop(name, None)
    return full
