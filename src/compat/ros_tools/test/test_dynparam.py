from ros_tools.ros.dynparam import with_timeout


def test_what_speaks_to_a_server_gets_a_time_limit():
    assert with_timeout(["dynparam", "get", "/amcl"]) == ["dynparam", "get", "--timeout=5.0", "/amcl"]


def test_a_limit_that_is_given_stays():
    assert with_timeout(["dynparam", "get", "-t", "60", "/amcl"]) == ["dynparam", "get", "-t", "60", "/amcl"]


def test_what_speaks_to_no_server_is_left_alone():
    assert with_timeout(["dynparam", "list"]) == ["dynparam", "list"]
