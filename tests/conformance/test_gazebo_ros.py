"""Statements of gazebo_ros 2.9 (gazebo_ros_api_plugin.cpp), each with the function that makes it."""

import math

import pytest
from gazebo_msgs.msg import LinkState, ModelState, ODEJointProperties, ODEPhysics
from gazebo_rig import Gazebo, pose_at
from genpy import Duration
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3, Wrench
from std_msgs.msg import ColorRGBA

BOX = """<sdf version='1.6'><model name='any'>{pose}<link name='part'>
<inertial><mass>1</mass></inertial><collision name='c'><geometry><box><size>0.2 0.2 0.2</size></box>
</geometry></collision></link></model></sdf>"""
URDF_BOX = """<robot name='any'>{origin}<link name='part'><inertial><mass value='1'/>
<inertia ixx='0.01' iyy='0.01' izz='0.01'/></inertial><collision><geometry><box size='0.2 0.2 0.2'/>
</geometry></collision></link></robot>"""
CART = """<robot name='cart'><link name='base_footprint'><inertial><mass value='5'/>
<inertia ixx='0.1' iyy='0.1' izz='0.1'/></inertial><collision><origin xyz='0 0 0.1'/>
<geometry><box size='0.3 0.3 0.2'/></geometry></collision></link>
<gazebo><plugin name='p' filename='libgazebo_ros_planar_move.so'>{}</plugin></gazebo></robot>"""
SERVICES = {
    "spawn_sdf_model": "gazebo_msgs/SpawnModel",
    "spawn_urdf_model": "gazebo_msgs/SpawnModel",
    "delete_model": "gazebo_msgs/DeleteModel",
    "delete_light": "gazebo_msgs/DeleteLight",
    "get_model_properties": "gazebo_msgs/GetModelProperties",
    "get_model_state": "gazebo_msgs/GetModelState",
    "get_world_properties": "gazebo_msgs/GetWorldProperties",
    "get_joint_properties": "gazebo_msgs/GetJointProperties",
    "get_link_properties": "gazebo_msgs/GetLinkProperties",
    "get_link_state": "gazebo_msgs/GetLinkState",
    "get_light_properties": "gazebo_msgs/GetLightProperties",
    "set_light_properties": "gazebo_msgs/SetLightProperties",
    "get_physics_properties": "gazebo_msgs/GetPhysicsProperties",
    "set_link_properties": "gazebo_msgs/SetLinkProperties",
    "set_physics_properties": "gazebo_msgs/SetPhysicsProperties",
    "set_model_state": "gazebo_msgs/SetModelState",
    "set_model_configuration": "gazebo_msgs/SetModelConfiguration",
    "set_joint_properties": "gazebo_msgs/SetJointProperties",
    "set_link_state": "gazebo_msgs/SetLinkState",
    "unpause_physics": "std_srvs/Empty",
    "pause_physics": "std_srvs/Empty",
    "apply_body_wrench": "gazebo_msgs/ApplyBodyWrench",
    "apply_joint_effort": "gazebo_msgs/ApplyJointEffort",
    "clear_joint_forces": "gazebo_msgs/JointRequest",
    "clear_body_wrenches": "gazebo_msgs/BodyRequest",
    "reset_simulation": "std_srvs/Empty",
    "reset_world": "std_srvs/Empty",
}
SCOPE = "did you forget to scope the link by model name?"


@pytest.fixture
def gazebo(monkeypatch, tmp_path):
    return Gazebo(monkeypatch, tmp_path)


def spawn(
    gazebo, xml=BOX.format(pose=""), pose=None, name="new", frame="", service="spawn_sdf_model", namespace=""
):
    answer = gazebo.call(service, name, xml, namespace, pose or pose_at(z=0.1), frame)
    return answer.success, answer.status_message


def position(gazebo, model, frame=""):
    at = gazebo.call("get_model_state", model, frame).pose.position
    return at.x, at.y, at.z


def yaw_of(pose):
    return 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)


@pytest.mark.parametrize("name", SERVICES)
def test_a_service_is_advertised_with_its_type(gazebo, name):
    """advertiseServices."""
    assert gazebo.service_types[name] == SERVICES[name]


def test_model_states_list_each_model_with_its_pose_and_twist_in_the_world(gazebo):
    """publishModelStates."""
    message = gazebo.published("model_states")
    assert set(message.name) == {"ground_plane", "crate", "door", "shelf"}
    assert len(message.pose) == len(message.twist) == len(message.name)
    assert message.pose[message.name.index("shelf")].position.x == 5.0


def test_link_states_are_named_model_and_link(gazebo):
    """publishLinkStates: body->GetScopedName()."""
    message = gazebo.published("link_states")
    assert {"crate::body", "door::frame", "door::wing", "shelf::board"} < set(message.name)
    assert message.pose[message.name.index("door::wing")].position.z == pytest.approx(0.6, abs=1e-3)


def test_a_model_state_on_the_topic_is_set(gazebo):
    """updateModelState."""
    gazebo.send("set_model_state", ModelState("crate", pose_at(3.0, 1.0, 0.1), Twist(), ""))
    assert position(gazebo, "crate") == pytest.approx((3.0, 1.0, 0.1))


def test_a_link_state_on_the_topic_is_set(gazebo):
    """updateLinkState."""
    gazebo.send("set_link_state", LinkState("crate::body", pose_at(3.0, 1.0, 0.1), Twist(), "world"))
    assert position(gazebo, "crate") == pytest.approx((3.0, 1.0, 0.1))


def test_a_spawned_model_gets_the_name_of_the_request(gazebo):
    """updateSDFAttributes: replaces the name by the user's."""
    assert spawn(gazebo) == (True, "SpawnModel: Successfully spawned entity")
    assert "new" in gazebo.call("get_world_properties").model_names


def test_the_pose_of_a_spawned_model_is_composed_with_the_request(gazebo):
    """updateSDFAttributes: new_model_pose = model_pose + initial pose."""
    xml = BOX.format(pose="<pose>1 0 0.5 0 0 0.2</pose>")
    spawn(gazebo, xml, pose_at(3.0, 4.0, 0.0, math.pi / 2.0))
    state = gazebo.call("get_model_state", "new", "")
    assert position(gazebo, "new") == pytest.approx((3.0, 5.0, 0.5), abs=1e-6)
    assert yaw_of(state.pose) == pytest.approx(math.pi / 2.0 + 0.2)


def test_the_pose_of_an_include_is_composed_with_the_request(gazebo, tmp_path):
    """updateSDFAttributes: the <pose> of the <include> replaces the included model's."""
    (tmp_path / "crate").mkdir()
    (tmp_path / "crate" / "model.config").write_text("<model><sdf version='1.6'>model.sdf</sdf></model>")
    (tmp_path / "crate" / "model.sdf").write_text(BOX.format(pose="<pose>9 9 9 0 0 0</pose>"))
    include = "<include><uri>model://crate</uri><pose>0 0 0.5 0 0 0</pose></include>"
    xml = f"<sdf version='1.6'><world name='w'>{include}</world></sdf>"
    assert spawn(gazebo, xml, pose_at(3.0, 4.0))[0]
    assert position(gazebo, "new") == pytest.approx((3.0, 4.0, 0.5))


def test_the_reference_frame_of_a_spawn_may_be_a_model(gazebo):
    """spawnSDFModel: initial_xyz = frame_pose.Pos() + Rot().RotateVector(initial_xyz)."""
    spawn(gazebo, pose=pose_at(1.0, 0.0, 0.1), frame="shelf")
    assert position(gazebo, "new") == pytest.approx((5.0, 1.0, 0.6), abs=1e-4)


@pytest.mark.parametrize("frame", ["", "world", "map", "/map"])
def test_world_and_map_are_the_inertial_frame(gazebo, frame):
    """spawnSDFModel, getModelState."""
    assert spawn(gazebo, pose=pose_at(1.0, 2.0, 0.1), frame=frame)[0]
    assert position(gazebo, "new", frame) == pytest.approx((1.0, 2.0, 0.1))


def test_an_unknown_reference_frame_of_a_spawn_fails(gazebo):
    """spawnSDFModel."""
    text = f"SpawnModel: reference reference_frame not found, {SCOPE}"
    assert spawn(gazebo, frame="nothing") == (False, text)


def test_a_name_that_is_taken_fails(gazebo):
    """spawnAndConform."""
    assert spawn(gazebo, name="crate") == (False, "SpawnModel: Failure - entity already exists.")


def test_spawn_sdf_model_accepts_urdf(gazebo):
    """spawnSDFModel: else if (isURDF(model_xml))."""
    assert spawn(gazebo, URDF_BOX.format(origin=""))[0]


def test_a_light_is_spawned_under_the_requested_name(gazebo):
    """spawnAndConform: isLight."""
    xml = "<sdf version='1.6'><light name='any' type='point'><diffuse>1 0 0 1</diffuse></light></sdf>"
    assert spawn(gazebo, xml, name="lamp") == (True, "SpawnModel: Successfully spawned entity")
    assert gazebo.call("get_light_properties", "lamp").diffuse == ColorRGBA(1.0, 0.0, 0.0, 1.0)
    assert spawn(gazebo, xml, name="lamp")[1] == "SpawnModel: Failure - entity already exists."


@pytest.mark.parametrize(
    ("own", "expected"), [("", "of_request"), ("<robotNamespace>own</robotNamespace>", "own")]
)
def test_the_robot_namespace_of_a_request_is_for_plugins_without_one(gazebo, own, expected):
    """walkChildAddRobotNamespace."""
    assert spawn(gazebo, CART.format(own), name="r", service="spawn_urdf_model", namespace="of_request")[0]
    assert gazebo.robots.namespaces["r"] == expected


def test_a_deleted_model_is_gone(gazebo):
    """deleteModel."""
    answer = gazebo.call("delete_model", "crate")
    assert (answer.success, answer.status_message) == (True, "DeleteModel: successfully deleted model")
    assert "crate" not in gazebo.call("get_world_properties").model_names


def test_deleting_a_model_that_does_not_exist_fails(gazebo):
    """deleteModel."""
    answer = gazebo.call("delete_model", "nothing")
    assert (answer.success, answer.status_message) == (False, "DeleteModel: model does not exist")


def test_deleting_a_model_ends_its_wrenches(gazebo):
    """deleteModel: clearBodyWrenches(body->GetScopedName())."""
    push(gazebo, "crate::body")
    gazebo.call("delete_model", "crate")
    spawn(gazebo, name="crate", pose=pose_at(2.0, 0.0, 0.1))
    gazebo.run(0.2)
    assert position(gazebo, "crate")[0] == pytest.approx(2.0, abs=1e-3)


def test_the_header_of_a_model_state_counts_the_calls_for_the_model(gazebo):
    """getModelState: access_count_get_model_state_, per model."""
    assert [gazebo.call("get_model_state", "crate", "").header.seq for _ in range(3)] == [1, 2, 3]
    assert gazebo.call("get_model_state", "door", "").header.seq == 1


def test_the_header_of_a_model_state_has_time_and_frame(gazebo):
    """getModelState: header.stamp = now, header.frame_id = relative_entity_name."""
    gazebo.run(0.5)
    header = gazebo.call("get_model_state", "crate", "shelf").header
    assert (header.frame_id, header.stamp.to_sec()) == ("shelf", 0.5)


def test_a_model_that_does_not_exist_has_an_empty_state(gazebo):
    """getModelState: returns before the header is filled in."""
    answer = gazebo.call("get_model_state", "nothing", "world")
    assert (answer.success, answer.status_message) == (False, "GetModelState: model does not exist")
    assert (answer.header.seq, answer.header.frame_id) == (0, "")


def test_an_unknown_frame_of_a_model_state_fails(gazebo):
    """getModelState."""
    answer = gazebo.call("get_model_state", "crate", "nothing")
    text = f"GetModelState: reference relative_entity_name not found, {SCOPE.replace('link', 'body')}"
    assert (answer.success, answer.status_message) == (False, text)


def test_a_relative_state_is_along_the_axes_of_the_frame(gazebo):
    """getModelState: RotateVectorReverse(model_linear_vel - frame_vpos)."""
    gazebo.send(
        "set_model_state",
        ModelState("crate", pose_at(5.0, 2.0, 0.1), Twist(Vector3(0.0, 0.7, 0.0), Vector3()), ""),
    )
    answer = gazebo.call("get_model_state", "crate", "shelf")
    assert (answer.pose.position.x, answer.pose.position.y) == pytest.approx((2.0, 0.0), abs=1e-5)
    assert (answer.twist.linear.x, answer.twist.linear.y) == pytest.approx((0.7, 0.0), abs=1e-5)
    assert answer.status_message == "GetModelState: got properties"


def test_properties_of_a_model_list_its_links_collisions_and_joints(gazebo):
    """getModelProperties: also its fixed joints."""
    answer = gazebo.call("get_model_properties", "door")
    assert (answer.body_names, answer.geom_names) == (["frame", "wing"], ["post", "plate"])
    assert answer.joint_names == ["mount", "hinge"]
    assert (answer.child_model_names, answer.parent_model_name, answer.is_static) == ([], "", False)
    assert answer.status_message == "GetModelProperties: got properties"


def test_a_static_model_is_static(gazebo):
    """getModelProperties: is_static."""
    assert gazebo.call("get_model_properties", "shelf").is_static


def test_properties_of_a_model_that_does_not_exist_fail(gazebo):
    """getModelProperties."""
    answer = gazebo.call("get_model_properties", "nothing")
    assert (answer.success, answer.status_message) == (False, "GetModelProperties: model does not exist")


def test_world_properties_have_time_and_models(gazebo):
    """getWorldProperties: rendering is always enabled."""
    gazebo.run(0.2)
    answer = gazebo.call("get_world_properties")
    assert (answer.sim_time, answer.rendering_enabled, answer.success) == (pytest.approx(0.2), True, True)
    assert answer.status_message == "GetWorldProperties: got properties"


def test_properties_of_a_joint_have_position_and_rate(gazebo):
    """getJointProperties."""
    gazebo.call("set_model_configuration", "door", "", ["hinge"], [0.4])
    answer = gazebo.call("get_joint_properties", "hinge")
    assert (answer.type, answer.position, answer.rate) == (answer.REVOLUTE, [pytest.approx(0.4)], [0.0])
    assert answer.status_message == "GetJointProperties: got properties"


def test_properties_of_a_joint_that_does_not_exist_fail(gazebo):
    """getJointProperties."""
    answer = gazebo.call("get_joint_properties", "nothing")
    assert (answer.success, answer.status_message) == (False, "GetJointProperties: joint not found")


def test_properties_of_a_link_have_mass_and_inertia(gazebo):
    """getLinkProperties: the orientation of com is the identity."""
    answer = gazebo.call("get_link_properties", "crate::body")
    assert (answer.mass, answer.gravity_mode) == (2.0, True)
    assert (answer.ixx, answer.iyy, answer.izz) == pytest.approx((0.02, 0.03, 0.04))
    assert answer.com.orientation == Quaternion(0.0, 0.0, 0.0, 1.0)
    assert answer.status_message == "GetLinkProperties: got properties"


def test_properties_of_a_link_that_does_not_exist_fail(gazebo):
    """getLinkProperties."""
    answer = gazebo.call("get_link_properties", "nothing")
    assert (answer.success, answer.status_message) == (False, f"GetLinkProperties: link not found, {SCOPE}")


def test_properties_of_a_link_are_set(gazebo):
    """setLinkProperties."""
    inertia = {"ixx": 0.1, "iyy": 0.2, "izz": 0.3}
    answer = gazebo.call(
        "set_link_properties", "crate::body", Pose(), gravity_mode=False, mass=7.0, **inertia
    )
    assert (answer.success, answer.status_message) == (True, "SetLinkProperties: properties set")
    after = gazebo.call("get_link_properties", "crate::body")
    assert (after.mass, after.gravity_mode, after.iyy) == (7.0, False, pytest.approx(0.2))


def test_a_link_state_is_that_of_the_link(gazebo):
    """getLinkState."""
    answer = gazebo.call("get_link_state", "door::wing", "")
    state = answer.link_state
    assert (answer.success, answer.status_message) == (True, "GetLinkState: got state")
    assert (state.link_name, state.reference_frame) == ("door::wing", "")
    assert (state.pose.position.x, state.pose.position.z) == pytest.approx((0.5, 0.6), abs=1e-3)


def test_a_link_state_that_fails_is_empty(gazebo):
    """getLinkState: link_name is filled in at the end."""
    answer = gazebo.call("get_link_state", "nothing", "")
    assert (answer.success, answer.status_message) == (False, f"GetLinkState: link not found, {SCOPE}")
    assert answer.link_state.link_name == ""
    answer = gazebo.call("get_link_state", "crate::body", "nothing")
    assert answer.status_message == f"GetLinkState: reference reference_frame not found, {SCOPE}"


def test_the_zero_quaternion_of_a_model_state_is_no_rotation(gazebo):
    """setModelState: target_rot.Normalize() eliminates the invalid rotation (0, 0, 0, 0)."""
    state = ModelState("crate", Pose(Point(1.0, 2.0, 0.1), Quaternion(0.0, 0.0, 0.0, 0.0)), Twist(), "")
    assert gazebo.call("set_model_state", state).status_message == "SetModelState: set model state done"
    assert gazebo.call("get_model_state", "crate", "").pose.orientation.w == pytest.approx(1.0)


def test_a_twist_that_is_set_is_along_the_axes_of_the_reference_frame(gazebo):
    """setModelState: target_pos_dot = frame_pose.Rot().RotateVector(target_pos_dot)."""
    gazebo.call(
        "set_model_state",
        ModelState("crate", pose_at(2.0), Twist(Vector3(1.0, 0.0, 0.0), Vector3()), "shelf"),
    )
    linear = gazebo.call("get_model_state", "crate", "").twist.linear
    assert (linear.x, linear.y) == pytest.approx((0.0, 1.0), abs=1e-5)


def test_an_unknown_model_or_frame_is_not_set(gazebo):
    """setModelState."""
    for state, text in (
        (ModelState(model_name="nothing"), "SetModelState: model does not exist"),
        (
            ModelState(model_name="crate", reference_frame="nothing"),
            "SetModelState: specified reference frame entity does not exist",
        ),
    ):
        answer = gazebo.call("set_model_state", state)
        assert (answer.success, answer.status_message) == (False, text)


def test_link_states_are_set_or_fail(gazebo):
    """setLinkState."""
    for state, expected in (
        (LinkState("crate::body", pose_at(1.0, 0.0, 0.1), Twist(), "world"), (True, "SetLinkState: success")),
        (LinkState(link_name="nothing"), (False, "SetLinkState: link does not exist")),
        (LinkState("crate::body", Pose(), Twist(), "nothing"), (False, "SetLinkState: failed")),
    ):
        answer = gazebo.call("set_link_state", state)
        assert (answer.success, answer.status_message) == expected


def test_a_configuration_sets_the_positions_of_joints(gazebo):
    """setModelConfiguration: names of joints that do not exist are ignored (SetJointPositions)."""
    answer = gazebo.call("set_model_configuration", "door", "", ["hinge", "nothing"], [0.7, 1.0])
    assert (answer.success, answer.status_message) == (True, "SetModelConfiguration: success")
    assert gazebo.call("get_joint_properties", "door::hinge").position == [pytest.approx(0.7)]


def test_a_configuration_of_different_lengths_or_of_no_model_fails(gazebo):
    """setModelConfiguration."""
    text = "SetModelConfiguration: joint name and position list have different lengths"
    assert gazebo.call("set_model_configuration", "door", "", ["hinge"], []).status_message == text
    text = "SetModelConfiguration: model does not exist"
    assert gazebo.call("set_model_configuration", "nothing", "", [], []).status_message == text


def test_properties_of_a_joint_are_set(gazebo):
    """setJointProperties: damping, hiStop and loStop."""
    properties = ODEJointProperties(damping=[2.0], hiStop=[0.3], loStop=[-0.3])
    answer = gazebo.call("set_joint_properties", "hinge", properties)
    assert (answer.success, answer.status_message) == (True, "SetJointProperties: properties set")
    gazebo.call("apply_joint_effort", "hinge", 5.0, duration=Duration(-1))
    gazebo.run(3.0)
    assert gazebo.call("get_joint_properties", "hinge").position[0] == pytest.approx(0.3, abs=0.02)
    answer = gazebo.call("set_joint_properties", "nothing", properties)
    assert (answer.success, answer.status_message) == (False, "SetJointProperties: joint not found")


def push(gazebo, body, frame="", seconds=-1.0, force=50.0, point=(0.0, 0.0, 0.0)):
    wrench, duration = Wrench(force=Vector3(force, 0.0, 0.0)), Duration.from_sec(seconds)
    return gazebo.call("apply_body_wrench", body, frame, Point(*point), wrench, duration=duration)


def test_a_wrench_in_the_world_frame_pushes_along_its_axes(gazebo):
    """applyBodyWrench: the message of a success is empty."""
    answer = push(gazebo, "crate::body")
    assert (answer.success, answer.status_message) == (True, "")
    gazebo.run(0.3)
    assert position(gazebo, "crate")[0] > 2.05


def test_a_wrench_in_a_frame_pushes_along_the_axes_of_the_frame(gazebo):
    """applyBodyWrench: transformWrench rotates the force. Stated difference: into the world, not the body."""
    push(gazebo, "crate::body", "shelf", point=(0.0, 3.0, -0.4))
    gazebo.run(0.3)
    x, y, _ = position(gazebo, "crate")
    assert (x, y > 0.05) == (pytest.approx(2.0, abs=0.01), True)


@pytest.mark.parametrize(("seconds", "moves_on"), [(0.1, False), (-1.0, True)])
def test_a_wrench_ends_after_its_duration_and_a_negative_one_does_not_end(gazebo, seconds, moves_on):
    """wrenchBodySchedulerSlot."""
    push(gazebo, "crate::body", seconds=seconds, force=-50.0)
    gazebo.run(1.0)
    before = position(gazebo, "crate")[0]
    gazebo.run(0.2)
    assert (position(gazebo, "crate")[0] < before - 0.05) == moves_on


def test_a_wrench_on_no_body_or_in_no_frame_fails(gazebo):
    """applyBodyWrench."""
    assert push(gazebo, "nothing").status_message == "ApplyBodyWrench: body does not exist"
    assert (
        push(gazebo, "crate::body", "nothing").status_message == "ApplyBodyWrench: reference_frame not found"
    )


def test_wrenches_of_a_body_are_cleared(gazebo):
    """clearBodyWrenches: by the scoped name."""
    push(gazebo, "crate::body")
    gazebo.call("clear_body_wrenches", "crate::body")
    gazebo.run(0.3)
    assert position(gazebo, "crate")[0] == pytest.approx(2.0, abs=1e-3)


def test_an_effort_turns_a_joint_until_it_is_cleared(gazebo):
    """applyJointEffort, clearJointForces."""
    answer = gazebo.call("apply_joint_effort", "hinge", 1.0, duration=Duration(-1))
    assert (answer.success, answer.status_message) == (True, "ApplyJointEffort: effort set")
    gazebo.run(0.2)
    rates = []
    for _ in range(2):
        gazebo.call("clear_joint_forces", "hinge")
        rates.append(gazebo.call("get_joint_properties", "hinge").rate[0])
        gazebo.run(0.1)
    assert rates[0] > 0.1
    assert rates[1] == pytest.approx(rates[0], rel=0.05)


def test_an_effort_on_no_joint_fails(gazebo):
    """applyJointEffort."""
    answer = gazebo.call("apply_joint_effort", "nothing", 1.0)
    assert (answer.success, answer.status_message) == (False, "ApplyJointEffort: joint not found")


def test_physics_properties_have_the_settings_of_ode(gazebo):
    """getPhysicsProperties; values of physics.sdf."""
    answer = gazebo.call("get_physics_properties")
    assert (answer.success, answer.status_message) == (True, "GetPhysicsProperties: got properties")
    ode = answer.ode_config
    assert (ode.sor_pgs_iters, ode.sor_pgs_w, ode.erp, ode.cfm) == (50, 1.3, 0.2, 0.0)
    assert (ode.contact_surface_layer, ode.contact_max_correcting_vel, ode.max_contacts) == (0.001, 100.0, 20)
    assert answer.gravity.z == -9.8
    assert answer.time_step == pytest.approx(0.005)


def test_physics_properties_that_were_read_can_be_set(gazebo):
    """setPhysicsProperties."""
    read = gazebo.call("get_physics_properties")
    answer = gazebo.call("set_physics_properties", 0.001, 1000.0, Vector3(0.0, 0.0, -1.6), read.ode_config)
    assert (answer.success, answer.status_message) == (True, "physics engine updated")
    after = gazebo.call("get_physics_properties")
    assert (after.time_step, after.max_update_rate, after.gravity.z) == (pytest.approx(0.001), 1000.0, -1.6)
    assert gazebo.log == [], "nothing that has no effect was changed"


def test_a_setting_of_ode_that_is_changed_is_kept_and_logged_as_without_effect(gazebo):
    """setPhysicsProperties. Stated difference: there is no ODE."""
    config = gazebo.call("get_physics_properties").ode_config
    config = ODEPhysics(**{name: getattr(config, name) for name in config.__slots__})
    config.sor_pgs_iters = 100
    gazebo.call("set_physics_properties", 0.005, 200.0, Vector3(0.0, 0.0, -9.8), config)
    assert gazebo.call("get_physics_properties").ode_config.sor_pgs_iters == 100
    assert len(gazebo.log) == 1
    assert "sor_pgs_iters has no effect" in gazebo.log[0]


def test_dynamic_reconfigure_has_the_parameters_of_physics_cfg(gazebo):
    """Physics.cfg."""
    assert list(gazebo.parameters) == [
        *("time_step", "max_update_rate", "gravity_x", "gravity_y", "gravity_z", "auto_disable_bodies"),
        *("sor_pgs_precon_iters", "sor_pgs_iters", "sor_pgs_w", "sor_pgs_rms_error_tol"),
        *("contact_surface_layer", "contact_max_correcting_vel", "cfm", "erp", "max_contacts"),
    ]


def test_dynamic_reconfigure_sets_physics(gazebo):
    """physicsReconfigureCallback."""
    values = gazebo.reconfigure({**gazebo.parameter_values, "gravity_z": -3.7})
    assert values["gravity_z"] == gazebo.call("get_physics_properties").gravity.z == -3.7


@pytest.mark.parametrize(
    ("service", "call"),
    [
        ("pause_physics", "pause"),
        ("unpause_physics", "unpause"),
        ("reset_world", "reset_world"),
        ("reset_simulation", "reset_simulation"),
    ],
)
def test_time_is_paused_and_reset(gazebo, service, call):
    """pausePhysics, unpausePhysics, resetWorld, resetSimulation."""
    gazebo.call(service)
    assert gazebo.time.calls == [call]


def test_properties_of_a_light_are_read_and_set(gazebo):
    """getLightProperties, setLightProperties: the message of a success is empty."""
    answer = gazebo.call("get_light_properties", "sun")
    assert (answer.success, answer.status_message, answer.diffuse.r) == (True, "", 0.8)
    values = {"diffuse": ColorRGBA(0.1, 0.2, 0.3, 1.0), "attenuation_constant": 0.5}
    answer = gazebo.call("set_light_properties", "sun", **values)
    assert (answer.success, answer.status_message) == (True, "")
    after = gazebo.call("get_light_properties", "sun")
    assert (after.diffuse, after.attenuation_constant) == (ColorRGBA(0.1, 0.2, 0.3, 1.0), 0.5)


def test_an_unknown_light_fails(gazebo):
    """getLightProperties, setLightProperties."""
    for name, text in (("get", "getLightProperties"), ("set", "setLightProperties")):
        answer = gazebo.call(f"{name}_light_properties", "nothing")
        assert (answer.success, answer.status_message) == (
            False,
            f"{text}: Requested light nothing not found!",
        )


def test_a_light_is_deleted(gazebo):
    """deleteLight."""
    answer = gazebo.call("delete_light", "sun")
    assert (answer.success, answer.status_message) == (True, "DeleteLight: sun successfully deleted")
    assert not gazebo.call("get_light_properties", "sun").success


def test_deleting_an_unknown_light_fails(gazebo):
    """deleteLight. Stated difference: the original overwrites this text by that of a time-out."""
    answer = gazebo.call("delete_light", "nothing")
    assert (answer.success, answer.status_message) == (
        False,
        "DeleteLight: Requested light nothing not found!",
    )


def test_what_has_no_effect_in_a_spawned_model_is_logged_with_its_line(gazebo):
    """Stated difference: Gazebo's parser passes over unknown elements."""
    xml = BOX.format(pose="\n<wheels>4</wheels>")
    spawn(gazebo, xml)
    assert gazebo.log[0] == "new:2: sdf > model 'any' > wheels: has no effect"
    assert gazebo.log[1].startswith("1 setting without effect, see the lines above")
