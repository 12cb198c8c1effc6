"""Names of packages that projects vendor as source, and whose function the simulation provides."""

from typing import FrozenSet

# By repository, with the names of its packages: a package of the author's that only begins alike is built.
_REPOSITORIES = (
    # slam_gmapping, navigation, and others of their kind
    "openslam_gmapping gmapping slam_gmapping amcl map_server move_base move_slow_and_clear navfn "
    "nav_core global_planner base_local_planner dwa_local_planner costmap_2d voxel_grid carrot_planner "
    "clear_costmap_recovery rotate_recovery fake_localization robot_pose_ekf depthimage_to_laserscan "
    "explore_lite multirobot_map_merge rtabmap rtabmap_ros",
    # gazebo_ros_pkgs
    "gazebo_ros gazebo_ros_control gazebo_plugins gazebo_dev gazebo_msgs gazebo_ros_pkgs",
    # turtlebot and its companions
    "turtlebot turtlebot_bringup turtlebot_capabilities turtlebot_description turtlebot_teleop "
    "turtlebot_actions turtlebot_apps turtlebot_calibration turtlebot_follower turtlebot_navigation "
    "turtlebot_rapps turtlebot_gazebo turtlebot_simulator turtlebot_stage turtlebot_stdr "
    "turtlebot_dashboard turtlebot_interactions turtlebot_interactive_markers turtlebot_rviz_launchers "
    "turtlebot_msgs turtlebot_arm turtlebot_create turtlebot_create_desktop turtlebot_kinect "
    "turtlebot_viz",
    "turtlebot3 turtlebot3_bringup turtlebot3_description turtlebot3_example turtlebot3_fake "
    "turtlebot3_gazebo turtlebot3_msgs turtlebot3_navigation turtlebot3_simulations turtlebot3_slam "
    "turtlebot3_teleop",
    "create_bringup create_dashboard create_description create_driver create_gazebo_plugins create_msgs "
    "create_node create_robot",
    # kobuki
    "kobuki kobuki_apps kobuki_auto_docking kobuki_bumper2pc kobuki_capabilities "
    "kobuki_controller_tutorial kobuki_core kobuki_dashboard kobuki_description kobuki_desktop "
    "kobuki_dock_drive kobuki_driver kobuki_ftdi kobuki_gazebo kobuki_gazebo_plugins kobuki_keyop "
    "kobuki_led_controller kobuki_msgs kobuki_node kobuki_qtestsuite kobuki_random_walker kobuki_rapps "
    "kobuki_rviz_launchers kobuki_safety_controller kobuki_soft kobuki_soft_apps kobuki_softapps "
    "kobuki_softnode kobuki_testsuite",
    # yujin_ocs
    "yocs_ar_marker_tracking yocs_ar_pair_approach yocs_ar_pair_tracking yocs_cmd_vel_mux "
    "yocs_controllers yocs_diff_drive_pose_controller yocs_joyop yocs_keyop yocs_localization_manager "
    "yocs_math_toolkit yocs_msgs yocs_navi_toolkit yocs_navigator yocs_rapps yocs_robot_pose_ekf "
    "yocs_safety_controller yocs_velocity_smoother yocs_virtual_sensor yocs_waypoint_provider "
    "yocs_waypoints_navi yujin_maps yujin_ocs",
    # ecl_core, ecl_lite, ecl_navigation, ecl_tools
    "ecl ecl_build ecl_command_line ecl_concepts ecl_config ecl_console ecl_containers ecl_converters "
    "ecl_converters_lite ecl_core ecl_core_apps ecl_devices ecl_eigen ecl_errors ecl_exceptions "
    "ecl_filesystem ecl_formatters ecl_geometry ecl_io ecl_ipc ecl_license ecl_linear_algebra ecl_lite "
    "ecl_manipulation ecl_manipulators ecl_math ecl_mobile_robot ecl_mpl ecl_navigation ecl_sigslots "
    "ecl_sigslots_lite ecl_statistics ecl_streams ecl_threads ecl_time ecl_time_lite ecl_tools "
    "ecl_type_traits ecl_utilities",
    # drivers of cameras
    "realsense2_camera realsense2_description realsense_camera realsense_ros freenect_camera "
    "freenect_launch freenect_stack openni_camera openni_launch openni_description openni2_camera "
    "openni2_launch",
)
_NAMES: FrozenSet[str] = frozenset(name for names in _REPOSITORIES for name in names.split())


def is_vendored(package: str) -> bool:
    """Whether a package has the name of a public one that the simulation makes unnecessary."""
    return package in _NAMES
