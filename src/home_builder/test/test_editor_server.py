"""The server of the editor: access, saving, and errors as sentences."""

import http.client
import io
import json
import threading
from urllib.parse import parse_qs, urlsplit

import pytest
from made_drawings import draw_floor_plan
from PIL import Image

from home_builder import HomePlan, Wall, load_plan
from home_builder.editor.server import EditorServer, address_and_port
from home_builder.editor.session import EditorSession
from home_builder.errors import EditorError
from home_builder.plan.file import plan_entries, plan_text

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
    connection = http.client.HTTPConnection(url.netloc, timeout=60.0)  # importers take long to load
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


def put_plan(server, plan, headers, version):
    content = json.dumps(plan_entries(plan))
    return request(server, "PUT", "/plan", content, **{**headers, "If-Match": version})


def test_a_plan_that_was_changed_elsewhere_is_not_overwritten(server, tmp_path):
    headers = access(server)
    version = json.loads(request(server, "GET", "/plan", **headers)[1])["version"]
    (tmp_path / "flat/plan.yaml").write_text(plan_text(HomePlan("by hand", PLAN.walls)))
    answer, content = put_plan(server, HomePlan("drawn", PLAN.walls), headers, version)
    assert answer.status == 422
    assert "was changed elsewhere" in json.loads(content)["error"]
    assert load_plan(tmp_path / "flat/plan.yaml").name == "by hand"
    assert load_plan(tmp_path / "flat/plan_refused.yaml").name == "drawn"
    state = json.loads(request(server, "GET", "/plan", **headers)[1])
    assert state["plan"]["name"] == "by hand"
    answer, content = put_plan(server, HomePlan("drawn", PLAN.walls), headers, state["version"])
    assert answer.status == 200
    assert put_plan(server, PLAN, headers, json.loads(content)["version"])[0].status == 200


def test_a_plan_that_was_removed_or_damaged_while_it_is_edited_is_stated_or_kept(server, tmp_path):
    headers, path = access(server), tmp_path / "flat/plan.yaml"
    path.unlink()
    assert json.loads(request(server, "GET", "/plan", **headers)[1])["plan"]["name"] == "flat"
    assert load_plan(path) == PLAN
    path.write_text("walls: 3")
    answer, content = request(server, "GET", "/plan", **headers)
    assert answer.status == 422
    assert "plan.yaml:1: walls must be a list of tables" in json.loads(content)["error"]


def test_a_template_is_kept_in_the_folder_and_traced(server, tmp_path):
    headers = access(server)
    draw_floor_plan(tmp_path / "plan.png")
    picture = (tmp_path / "plan.png").read_bytes()
    answer, content = request(server, "PUT", "/template", picture, **headers)
    template = json.loads(content)["template"]
    assert (answer.status, template["width"], template["height"]) == (200, 1000, 700)
    answer, content = request(server, "GET", f"/{template['file']}", **headers)
    assert (answer.headers["Content-Type"], content) == ("image/png", picture)
    plan = {**plan_entries(PLAN), "template": {**template, "x": 20.0, "y": 10.0, "scale": 0.01}}
    request(server, "PUT", "/plan", json.dumps(plan), **headers)
    found = json.loads(request(server, "POST", "/trace", **headers)[1])["found"]
    assert len(found["walls"]) == 5
    xs = [point[0] for wall in found["walls"] for point in (wall["start"], wall["end"])]
    assert min(xs) == pytest.approx(20.9, abs=0.05)  # the outer face
    assert load_plan(tmp_path / "flat/plan.yaml").template.x == 20.0
    EditorSession(tmp_path / "flat").close()
    assert (tmp_path / "flat" / template["file"]).is_file()
    EditorSession(tmp_path / "flat", PLAN).close()  # no longer used by its plan
    assert not (tmp_path / "flat" / template["file"]).exists()


def picture_of(kind, size, **options) -> bytes:
    content = io.BytesIO()
    Image.new("1" if kind == "PNG" else "L", size, 1).save(content, kind, **options)
    return content.getvalue()


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (b"dear", "the template is not a readable picture (unknown format)"),
        (picture_of("PNG", (20, 10))[:40], "the template is not a readable picture"),
        (picture_of("PNG", (20_000, 10_000)), "the template has 20000 x 10000 pixels, more than 60 million"),
        (picture_of("TIFF", (20, 10)), "the template must be one of PNG, JPEG, GIF, WEBP, BMP"),
    ],
)
def test_what_is_no_template_is_refused_in_a_sentence(server, content, complaint, tmp_path):
    answer, text = request(server, "PUT", "/template", content, **access(server))
    assert answer.status == 422
    assert complaint in json.loads(text)["error"]
    assert [path.name for path in (tmp_path / "flat").iterdir()] == ["plan.yaml"]


def test_a_photograph_is_as_wide_as_browsers_show_it(server):
    exif = Image.Exif()
    exif[0x0112] = 6  # the camera was turned
    _, text = request(server, "PUT", "/template", picture_of("JPEG", (40, 20), exif=exif), **access(server))
    template = json.loads(text)["template"]
    assert (template["width"], template["height"]) == (20, 40)


def test_other_files_of_the_folder_are_no_templates(server):
    headers = access(server)
    for name in ("template_../plan.yaml", "template_000000000000.png"):
        answer, text = request(server, "GET", f"/{name}", **headers)
        assert answer.status == 422
        assert "the template is missing" in json.loads(text)["error"]
    answer, text = request(server, "POST", "/trace", **headers)
    assert "choose a picture of a floor plan" in json.loads(text)["error"]


def test_only_the_page_that_is_named_may_show_the_editor(server, tmp_path):
    answer, _ = request(server, "GET", "/", **access(server))
    assert "frame-ancestors 'none'" in answer.headers["Content-Security-Policy"]
    with pytest.raises(EditorError, match="expected an origin"):
        EditorServer(EditorSession(tmp_path / "other"), frame_of="http://x; script-src *")
    framed = EditorServer(EditorSession(tmp_path / "other"), frame_of="http://127.0.0.1:8700")
    thread = threading.Thread(target=framed.serve)
    thread.start()
    answer, _ = request(framed, "GET", "/", **access(framed))
    framed.close()
    thread.join(10.0)
    assert answer.headers["Content-Security-Policy"].endswith("frame-ancestors http://127.0.0.1:8700")


def test_the_map_is_shown_once_it_is_built(server):
    headers = access(server)
    assert request(server, "GET", "/map.png", **headers)[0].status == 422
    walls = [Wall((0.0, 0.0), (6.0, 0.0)), Wall((6.0, 0.0), (6.0, 5.0)), Wall((6.0, 5.0), (0.0, 5.0))]
    plan = HomePlan("flat", (*walls, Wall((0.0, 5.0), (0.0, 0.0))), start=(2.0, 2.0))
    request(server, "PUT", "/plan", json.dumps(plan_entries(plan)), **headers)
    assert request(server, "POST", "/build", **headers)[0].status == 200
    answer, content = request(server, "GET", "/map.png", **headers)
    assert answer.headers["Content-Type"] == "image/png"
    assert Image.open(io.BytesIO(content)).width > 100
