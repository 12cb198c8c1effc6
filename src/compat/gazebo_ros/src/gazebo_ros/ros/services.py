"""Clients of Gazebo's services."""

import rospy
from gazebo_msgs.srv import SetModelConfiguration, SpawnModel

SERVICE_SECONDS = 60.0


def spawn_sdf_model_client(
    model_name, model_xml, robot_namespace, initial_pose, reference_frame, gazebo_namespace
):
    """Spawn an SDF model; returns whether it succeeded."""
    request = (model_name, model_xml, robot_namespace, initial_pose, reference_frame)
    return _call(f"{gazebo_namespace}/spawn_sdf_model", SpawnModel, request)


def spawn_urdf_model_client(
    model_name, model_xml, robot_namespace, initial_pose, reference_frame, gazebo_namespace
):
    """Spawn a URDF model; returns whether it succeeded."""
    request = (model_name, model_xml, robot_namespace, initial_pose, reference_frame)
    return _call(f"{gazebo_namespace}/spawn_urdf_model", SpawnModel, request)


def set_model_configuration_client(
    model_name, model_param_name, joint_names, joint_positions, gazebo_namespace
):
    """Set joint positions; returns whether it succeeded."""
    request = (model_name, model_param_name, joint_names, joint_positions)
    return _call(f"{gazebo_namespace}/set_model_configuration", SetModelConfiguration, request)


def _call(service, kind, request):
    rospy.wait_for_service(service, SERVICE_SECONDS)
    response = rospy.ServiceProxy(service, kind)(*request)
    log = rospy.loginfo if response.success else rospy.logerr
    log("%s", response.status_message)
    return response.success
