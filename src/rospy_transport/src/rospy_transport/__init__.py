"""Every access to private parts of rospy; other packages use its public interface only.

Modules:
    replacements: The attributes of rospy that are replaced, all by ``install``.
    connections: What rospy knows about the topics and connections of this node.
    node: ROS time, remapped names, and the end of this node.

``test/`` checks the assumed shape of rospy, for rospy 1.15 to 1.17.
"""
