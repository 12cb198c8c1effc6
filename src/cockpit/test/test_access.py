"""Who is let in."""

import pytest

from cockpit.access import FORBIDDEN, OK, AccessPolicy

ACCESS = AccessPolicy(8700, token="secret")
HOST, COOKIE = "127.0.0.1:8700", "cockpit_8700=secret"


def status(target="/", host=HOST, origin=None, cookies=COOKIE, is_socket=False):
    return ACCESS.judge(target, host, origin, cookies, is_socket).status


def test_the_token_of_the_url_becomes_a_cookie_that_scripts_cannot_read():
    answer = ACCESS.judge("/?token=secret", HOST, None, "", False)
    assert answer.status == OK
    assert answer.cookie == "cockpit_8700=secret; HttpOnly; SameSite=Lax; Path=/"


def test_who_has_the_cookie_is_let_in():
    assert status() == OK
    assert status(cookies="other=1; cockpit_8700=secret", origin=f"http://{HOST}", is_socket=True) == OK


@pytest.mark.parametrize("host", ["localhost:8700", "127.0.0.1", "[::1]:8700", "localhost:9000"])
def test_this_machine_has_several_names_and_ports_may_be_forwarded(host):
    assert status(host=host, origin=f"http://{host}", is_socket=True) == OK


@pytest.mark.parametrize(
    "cookies", ["", "cockpit_8700=wrong", "cockpit_8701=secret", "cockpit_8700=", ";;=\x00"]
)
def test_without_the_token_nothing_is_shown(cookies):
    assert status(cookies=cookies) == FORBIDDEN
    assert status(cookies=cookies, origin=f"http://{HOST}", is_socket=True) == FORBIDDEN


@pytest.mark.parametrize(
    "target", ["/?token=wrong", "/?token=", "/?token=secre%C3%A9", "/?tokens=secret", "//["]
)
def test_a_wrong_token_is_refused(target):
    assert status(target, cookies="") == FORBIDDEN


@pytest.mark.parametrize("host", ["evil.example:8700", "127.0.0.1.evil.example", "", "[", "127.0.0.2:8700"])
def test_a_foreign_host_is_refused_even_with_the_cookie(host):
    assert status(host=host) == FORBIDDEN
    assert status("/?token=secret", host=host) == FORBIDDEN


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "https://127.0.0.1:8700", "null", "http://localhost:8700"]
)
def test_a_foreign_origin_is_refused_even_with_the_cookie(origin):
    assert status(origin=origin, is_socket=True) == FORBIDDEN
    assert status(origin=origin) == FORBIDDEN


def test_a_socket_without_an_origin_or_with_only_the_token_is_refused():
    assert status(is_socket=True) == FORBIDDEN
    assert status("/?token=secret", origin=f"http://{HOST}", cookies="", is_socket=True) == FORBIDDEN


def test_tokens_are_long_and_never_the_same():
    first, second = AccessPolicy(1).token, AccessPolicy(1).token
    assert first != second
    assert len(first) >= 32
