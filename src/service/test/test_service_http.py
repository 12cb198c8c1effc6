"""The HTTP interface."""

import json
import socket
import threading
import time
import urllib.error
import urllib.request

import pytest

pytest.importorskip("fastapi")
from service_bench import NOW, Bench  # noqa: E402

from planar import SettingsError  # noqa: E402
from service.commands.request import list_open  # noqa: E402
from service.host import ServiceHost  # noqa: E402
from service.http.client import RequestRefusedError, ServiceClient  # noqa: E402
from service.http.server import HttpServer  # noqa: E402


@pytest.fixture()
def folder(tmp_path):
    """A service over HTTP, with a robot whose time passes 200 times as fast."""
    bench = Bench()

    def make(journal):
        bench.service = Bench(journal.restore(), find_ended=journal.ended_task).service
        return bench.service

    host = ServiceHost(tmp_path / "journal.db", make)
    server, is_over = HttpServer(host, tmp_path), threading.Event()

    def run():
        now = NOW
        while not is_over.is_set():
            now += 0.5
            order = host.cycle(now, bench.robot.inputs(now), bench.robot.event(now))
            bench.robot.carry_out(order, now)
            time.sleep(0.0025)

    thread = threading.Thread(target=run)
    thread.start()
    server.start()
    yield tmp_path
    is_over.set()
    thread.join()
    server.stop()
    host.close()
    assert not (tmp_path / "service.json").exists()


def raw(folder, path, body=None, headers=None, method=None):
    document = json.loads((folder / "service.json").read_text())
    known = {"Authorization": f"Bearer {document['token']}"}
    request = urllib.request.Request(
        document["url"] + path, body, {**known, **(headers or {})}, method=method
    )
    try:
        with urllib.request.urlopen(request, timeout=10) as answer:
            return answer.status, json.load(answer)
    except urllib.error.HTTPError as error:
        return error.code, json.load(error)


def test_a_request_is_accepted_done_and_remembered(folder):
    client = ServiceClient(folder)
    events = client.events(after=0)
    task = client.submit({"text": "deliver cup from kitchen to desk", "by": "+1h", "requester": "anna"})
    assert task["status"] in ("queued", "underway") and task["in_time"]
    assert task["unix_millis_expected_finish_time"] > task["booking"]["unix_millis_request_time"]
    kinds = []
    for event in events:
        kinds.append((event["kind"], event["text"]))
        if event["kind"] == "ended":
            break
    assert kinds[0] == ("accepted", "from anna")
    assert ("step", "cup picked up") in kinds and kinds[-1] == ("ended", "completed")
    ended = client.call("GET", f"/tasks/{task['booking']['id']}")
    assert (ended["status"], ended["in_time"], ended["completed"]) == ("completed", True, [0, 1, 2, 3])
    assert client.call("GET", "/history")[0] == ended
    assert client.call("GET", "/state")["objects"] == {"cup": "desk"}
    assert client.call("GET", "/tasks") == []


def test_the_list_reads_as_the_requests_were_written(folder, capsys):
    client = ServiceClient(folder)
    client.submit({"text": "patrol kitchen desk 2 times", "not_before": "+1h"})
    list_open(client)
    assert "patrol kitchen desk 2 times" in capsys.readouterr().out


def test_requests_are_cancelled(folder):
    client = ServiceClient(folder)
    task = client.submit({"text": "go desk", "not_before": "+10h"})
    assert [each["booking"]["id"] for each in client.call("GET", "/tasks")] == [task["booking"]["id"]]
    assert client.call("DELETE", f"/tasks/{task['booking']['id']}") == {"success": True}
    assert client.call("GET", "/tasks") == []
    for path, status in ((f"/tasks/{task['booking']['id']}", 409), ("/tasks/77", 404)):
        with pytest.raises(RequestRefusedError) as error:
            client.call("DELETE", path)
        assert error.value.status == status


def test_a_request_that_is_sent_again_is_accepted_once(folder):
    client = ServiceClient(folder)
    first, second = (client.submit({"text": "wait 1h", "id": "anna:1"}) for _ in range(2))
    assert first["booking"] == second["booking"]
    assert len(client.call("GET", "/tasks")) == 1


@pytest.mark.parametrize(
    ("body", "status", "expected"),
    [
        (b"{", 400, "the body is no JSON"),
        (b"\xff\xfe", 400, "the body is no JSON"),
        (b"[" * 60_000, 400, "the body is no JSON"),
        (b'{"text": "' + b"x" * 70_000 + b'"}', 413, "at most 65536 bytes"),
        (b'{"text": "go cellar"}', 422, 'there is no place "cellar"'),
        (b"[]", 422, "not list"),
    ],
)
def test_bad_bodies_are_answered(folder, body, status, expected):
    found, document = raw(folder, "/tasks", body)
    assert found == status
    assert expected in document["problems"][0]


def test_all_problems_are_in_the_answer(folder):
    body = json.dumps({"text": "deliver cup from cellar to attic", "priority": -1}).encode()
    assert len(raw(folder, "/tasks", body)[1]["problems"]) == 3


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Authorization": "Bearer wrong"}, 401),
        ({"Authorization": ""}, 401),
        ({"Host": "evil.example"}, 403),
        ({"Origin": "http://evil.example"}, 403),
    ],
)
def test_access_needs_the_token_and_the_right_site(folder, headers, status):
    assert raw(folder, "/state", headers=headers)[0] == status


def test_the_schema_is_published(folder):
    status, schema = raw(folder, "/openapi.json", headers={"Authorization": ""})
    assert status == 200
    body = schema["paths"]["/tasks"]["post"]["requestBody"]["content"]["application/json"]["schema"]
    assert "unix_millis_earliest_start_time" in body["properties"]


def test_only_the_user_may_read_the_token(folder):
    assert (folder / "service.json").stat().st_mode & 0o777 == 0o600


def test_a_client_without_a_service_is_an_error(tmp_path):
    with pytest.raises(SettingsError, match="start ./scripts/service.sh"):
        ServiceClient(tmp_path)


def test_a_service_that_ends_in_the_middle_of_an_answer_does_not_answer(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as server:
        url = f"http://127.0.0.1:{server.getsockname()[1]}"
        (tmp_path / "service.json").write_text(json.dumps({"url": url, "token": "token", "pid": 1}))

        def answer_partly():
            connection, _ = server.accept()
            with connection:
                connection.recv(65536)
                connection.sendall(b"HTTP/1.1 201 Created\r\nContent-Length: 278\r\n\r\n{")

        threading.Thread(target=answer_partly, daemon=True).start()
        with pytest.raises(SettingsError, match="does not answer"):
            ServiceClient(tmp_path).submit({"text": "go desk"})
