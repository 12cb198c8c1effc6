from supervision.node_exits import MAX_RESTARTS, NodeExits, Restart


def exits_from(*lines, respawned=()):
    read = NodeExits("logs", respawned)
    for line in lines:
        read.read(line + "\n")
    return read


def killed(node):
    return f"[{node}-4] process has died [pid 18, exit code -9, cmd nodes/x]."


def test_a_node_that_dies_is_reported_with_its_error_line():
    failure = exits_from(
        "[/amcl] error: /amcl/max_particles must be at least 1, got -3",
        "[amcl-3] process has died [pid 17, exit code 2, cmd nodes/amcl_lite].",
    ).failure
    assert failure.text == "amcl: /amcl/max_particles must be at least 1, got -3"
    assert failure.is_bad_input


def test_a_node_that_dies_without_an_error_line_is_reported_with_its_signal():
    failure = exits_from("[move_base-4] process has died [pid 18, exit code -11, cmd nodes/x].").failure
    assert failure.text == "move_base: was ended by SIGSEGV, see logs"
    assert not failure.is_bad_input


def test_a_required_node_is_named_too():
    failure = exits_from(
        "================================================================================"
        "REQUIRED process [sim_bridge-2] has died!",
        "process has died [pid 18, exit code -9, cmd nodes/sim_bridge].",
        "log file: sim_bridge-2*.log",
    ).failure
    assert failure.text == "sim_bridge: was ended by SIGKILL, see logs"


def test_a_master_that_dies_is_named_too():
    failure = exits_from(
        "REQUIRED process [master] has died!",
        "process has died [pid 18, exit code -15, cmd rosmaster --core].",
    ).failure
    assert failure.text == "master: was ended by SIGTERM, see logs"


def test_a_respawned_node_is_no_failure():
    read = exits_from(killed("amcl"), killed("move_base"), respawned=("amcl", "move_base"))
    assert read.failure is None
    assert read.restarts == [
        Restart("amcl", "was ended by SIGKILL"),
        Restart("move_base", "was ended by SIGKILL"),
    ]


def test_a_node_that_dies_repeatedly_is_a_failure():
    read = exits_from(*[killed("amcl")] * (MAX_RESTARTS + 1), respawned=("amcl",))
    assert read.failure.text == "amcl: was ended by SIGKILL, after 3 restarts, see logs"
    assert len(read.restarts) == MAX_RESTARTS


def test_bad_input_and_a_failed_mission_are_final():
    for code, is_bad_input in ((2, True), (1, False)):
        failure = exits_from(
            "[/pick_objects] error: place pickup not reached",
            f"[pick_objects-6] process has died [pid 18, exit code {code}, cmd nodes/x].",
            respawned=("pick_objects",),
        ).failure
        assert failure.text == "pick_objects: place pickup not reached"
        assert failure.is_bad_input is is_bad_input


def test_a_graph_continues_without_rosout():
    read = exits_from(killed("rosout"), respawned=("amcl",))
    assert read.failure is None
    assert read.restarts == [Restart("rosout", "was ended by SIGKILL")]
