"""Calls of Gazebo's services, as other people's scripts import them."""

import rospy
from gazebo_msgs.srv import SetModelConfiguration, SpawnModel

SERVICE_SECONDS = 60.0


def spawn_sdf_model_client(
    model_name, model_xml, robot_namespace, initial_pose, reference_frame, gazebo_namespace
):
    """Spawns an SDF model; returns (success, status message)."""
    service = f"{gazebo_namespace}/spawn_sdf_model"
    return _spawn(service, model_name, model_xml, robot_namespace, initial_pose, reference_frame)


def spawn_urdf_model_client(
    model_name, model_xml, robot_namespace, initial_pose, reference_frame, gazebo_namespace
):
    """Spawns a URDF model; returns (success, status message)."""
    service = f"{gazebo_namespace}/spawn_urdf_model"
    return _spawn(service, model_name, model_xml, robot_namespace, initial_pose, reference_frame)


def set_model_configuration_client(
    model_name, model_param_name, joint_names, joint_positions, gazebo_namespace
):
    """Sets joint positions; returns (success, status message)."""
    response = _call(
        f"{gazebo_namespace}/set_model_configuration",
        SetModelConfiguration,
        (model_name, model_param_name, joint_names, joint_positions),
    )
    return response.success, response.status_message


def _spawn(service, *request):
    response = _call(service, SpawnModel, request)
    return response.success, response.status_message


def _call(service, kind, request):
    rospy.wait_for_service(service, SERVICE_SECONDS)
    return rospy.ServiceProxy(service, kind)(*request)
