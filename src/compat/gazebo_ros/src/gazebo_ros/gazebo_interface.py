"""Official module name for the clients of Gazebo's services."""

from gazebo_ros.ros.services import (
    set_model_configuration_client,
    spawn_sdf_model_client,
    spawn_urdf_model_client,
)

__all__ = ["set_model_configuration_client", "spawn_sdf_model_client", "spawn_urdf_model_client"]
