from supervision.ros.graph import RosGraph


def silent_graph():
    graph = RosGraph.__new__(RosGraph)
    graph._complaints, graph._failure, graph._log_folder = {}, None, "logs"
    return graph


def test_a_node_that_dies_is_reported_in_its_own_words():
    graph = silent_graph()
    graph._notice("[/amcl] error: /amcl/max_particles must be at least 1, got -3\n")
    graph._notice("[amcl-3] process has died [pid 17, exit code 2, cmd nodes/amcl_lite].\n")
    assert graph.failure.text == "amcl: /amcl/max_particles must be at least 1, got -3"
    assert graph.failure.is_bad_input


def test_a_node_that_dies_in_silence_is_reported_with_its_exit_code():
    graph = silent_graph()
    graph._notice("[move_base-4] process has died [pid 18, exit code -11, cmd nodes/x].\n")
    assert graph.failure.text == "move_base: died with exit code -11, see logs"
    assert not graph.failure.is_bad_input
