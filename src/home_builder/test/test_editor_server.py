"""The server of the editor: access, saving, and errors as sentences."""

import http.client
import json
import threading
from urllib.parse import parse_qs, urlsplit

import pytest

from home_builder import HomePlan, Wall, load_plan
from home_builder.editor.server import EditorServer, address_and_port
from home_builder.editor.session import EditorSession
from home_builder.errors import EditorError
from home_builder.plan.file import plan_entries

PLAN = HomePlan("flat", (Wall((0.0, 0.0), (3.0, 0.0)),), start=(1.0, 1.0))


@pytest.fixture(name="server")
def server_(tmp_path):
    server = EditorServer(EditorSession(tmp_path / "flat", PLAN))
    thread = threading.Thread(target=server.serve)
    thread.start()
    yield server
    server.close()
    thread.join(10.0)


def request(server, method, path, body=None, **headers):
    url = urlsplit(server.url)
    connection = http.client.HTTPConnection(url.netloc, timeout=10.0)
    connection.request(method, path, body, headers)
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    return answer, content


def access(server):
    """Headers of the page: its cookie and its origin."""
    token = parse_qs(urlsplit(server.url).query)["token"][0]
    answer, _ = request(server, "GET", f"/?token={token}")
    assert (answer.status, answer.headers["Location"]) == (303, "/")
    cookie = answer.headers["Set-Cookie"].partition(";")[0]
    return {"Cookie": cookie, "Origin": f"http://{urlsplit(server.url).netloc}"}


def test_the_page_and_the_plan_need_the_token(server):
    for path in ("/", "/plan", "/editor.js", "/?token=wrong"):
        assert request(server, "GET", path)[0].status == 403
    headers = access(server)
    answer, content = request(server, "GET", "/", **headers)
    assert answer.status == 200
    assert b"<title>Home editor</title>" in content
    state = json.loads(request(server, "GET", "/plan", **headers)[1])
    assert state["plan"] == json.loads(json.dumps(plan_entries(PLAN)))
    assert request(server, "GET", "/../session.py", **headers)[0].status == 404


@pytest.mark.parametrize("origin", ["http://elsewhere.example", None])
def test_a_page_of_another_site_changes_nothing(server, origin, tmp_path):
    headers = {**access(server), "Origin": origin}
    headers = {name: value for name, value in headers.items() if value}
    answer, _ = request(server, "PUT", "/plan", json.dumps({"name": "other"}), **headers)
    assert answer.status == 403
    assert load_plan(tmp_path / "flat/plan.yaml") == PLAN


def test_a_change_is_saved_and_judged(server, tmp_path):
    plan = HomePlan("flat", (*PLAN.walls, Wall((-1.0, 1.0), (2.0, 1.0))), start=(1.0, 1.0))
    answer, content = request(server, "PUT", "/plan", json.dumps(plan_entries(plan)), **access(server))
    assert answer.status == 200
    problems = json.loads(content)["problems"]
    assert problems[0]["text"] == "the start is in a wall or furniture, or too close to it"
    assert (problems[0]["x"], problems[0]["y"], problems[0]["is_error"]) == (1.0, 1.0, True)
    assert load_plan(tmp_path / "flat/plan.yaml") == plan


@pytest.mark.parametrize(
    "body",
    ["", "[]", "{", '{"walls": 3}', '{"walls": [{"start": [0, 0]}]}', "\udcff", '{"start": [1e400, 0]}'],
)
def test_a_body_that_is_no_plan_is_refused_in_a_sentence(server, body, tmp_path):
    content = body.encode("utf-8", "surrogateescape")
    answer, content = request(server, "PUT", "/plan", content, **access(server))
    assert answer.status == 422
    assert "Traceback" not in json.loads(content)["error"]
    assert load_plan(tmp_path / "flat/plan.yaml") == PLAN


def test_a_home_with_errors_is_not_built_and_states_why(server):
    headers = access(server)
    plan = {**plan_entries(PLAN), "start": [1.0, 0.0]}
    request(server, "PUT", "/plan", json.dumps(plan), **headers)
    answer, content = request(server, "POST", "/build", **headers)
    assert answer.status == 422
    assert "the start is in a wall or furniture" in json.loads(content)["error"]


def test_a_body_that_is_too_long_is_refused(server):
    headers = {**access(server), "Content-Length": str(1 << 30)}
    assert request(server, "PUT", "/plan", b"", **headers)[0].status == 400


def test_the_plan_of_a_folder_is_opened_again(tmp_path):
    EditorSession(tmp_path / "flat", PLAN)
    assert EditorSession(tmp_path / "flat").state()["plan"]["name"] == "flat"


def test_a_port_in_use_and_a_wrong_port_are_named(server, tmp_path):
    port = urlsplit(server.url).port
    with pytest.raises(EditorError, match=f"--web-port: 127.0.0.1:{port} cannot be served"):
        EditorServer(EditorSession(tmp_path / "other"), port=port)
    with pytest.raises(EditorError, match="expected"):
        address_and_port("http")
    assert address_and_port("0.0.0.0:8000") == ("0.0.0.0", 8000)
