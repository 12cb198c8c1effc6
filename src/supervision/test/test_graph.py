from supervision.ros.graph import RosGraph


def silent_graph():
    graph = RosGraph.__new__(RosGraph)
    graph._complaints, graph._failure, graph._log_folder, graph._required = {}, None, "logs", ""
    return graph


def test_a_node_that_dies_is_reported_in_its_own_words():
    graph = silent_graph()
    graph._notice("[/amcl] error: /amcl/max_particles must be at least 1, got -3\n")
    graph._notice("[amcl-3] process has died [pid 17, exit code 2, cmd nodes/amcl_lite].\n")
    assert graph.failure.text == "amcl: /amcl/max_particles must be at least 1, got -3"
    assert graph.failure.is_bad_input


def test_a_node_that_dies_in_silence_is_reported_with_what_ended_it():
    graph = silent_graph()
    graph._notice("[move_base-4] process has died [pid 18, exit code -11, cmd nodes/x].\n")
    assert graph.failure.text == "move_base: was ended by SIGSEGV, see logs"
    assert not graph.failure.is_bad_input


def test_a_node_without_which_there_is_no_run_is_named_too():
    graph = silent_graph()
    for line in (
        "================================================================================"
        "REQUIRED process [sim_bridge-2] has died!\n",
        "process has died [pid 18, exit code -9, cmd nodes/sim_bridge].\n",
        "log file: sim_bridge-2*.log\n",
    ):
        graph._notice(line)
    assert graph.failure.text == "sim_bridge: was ended by SIGKILL, see logs"


def test_a_master_that_dies_is_named_too():
    graph = silent_graph()
    graph._notice("REQUIRED process [master] has died!\n")
    graph._notice("process has died [pid 18, exit code -15, cmd rosmaster --core].\n")
    assert graph.failure.text == "master: was ended by SIGTERM, see logs"
