from ros_tools.ros.dynparam import with_timeout


def test_a_command_that_calls_a_server_gets_a_time_limit():
    assert with_timeout(["dynparam", "get", "/amcl"]) == ["dynparam", "get", "--timeout=5.0", "/amcl"]


def test_an_explicit_limit_is_kept():
    assert with_timeout(["dynparam", "get", "-t", "60", "/amcl"]) == ["dynparam", "get", "-t", "60", "/amcl"]


def test_other_commands_are_unchanged():
    assert with_timeout(["dynparam", "list"]) == ["dynparam", "list"]
