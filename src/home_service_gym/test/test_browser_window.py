"""render_mode "human": a browser page shows the environment."""

import re
import sys
import time
from pathlib import Path

import gymnasium
import pytest

from planar import SettingsError

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tests/shared"))
from page_client import PageClient  # noqa: E402
from waiting import wait_until  # noqa: E402

STEPS = 10


def wait_for_page(env, capsys):
    """Connect to the page of an environment that has just been reset."""
    return PageClient(re.search(r"environment: (\S+)", capsys.readouterr().out).group(1))


def images_after_a_step(env, page):
    """Step, resetting if the episode ends; return the number of images received so far."""
    *_, is_terminated, is_truncated, _ = env.step(env.action_space.sample())
    if is_terminated or is_truncated:
        env.reset()
    return page.pictures


@pytest.mark.parametrize("name", ["PointGoal-v0", "TurtleBot3Stage-v0"])
def test_an_open_page_shows_the_episode_in_real_time(name, capsys):
    env = gymnasium.make(f"home_service_gym:{name}", render_mode="human")
    env.reset(seed=0)
    with wait_for_page(env, capsys) as page:
        wait_until("a first image", lambda: page.pictures > 0)
        before = page.pictures
        # A busy page may skip states.
        wait_until("images of the episode", lambda: images_after_a_step(env, page) >= before + STEPS // 2)
        began = time.monotonic()
        for _ in range(STEPS):
            images_after_a_step(env, page)
        assert time.monotonic() - began > 0.8 * (STEPS - 1) / env.metadata["render_fps"]
        kinds = {node.strip("/").partition("/")[0] for node in page.nodes}
        assert {"world", "robots", "layers"} <= kinds
        env.close()
        page.wait_until_closed()


def test_a_new_world_replaces_the_previous_one(capsys):
    env = gymnasium.make("home_service_gym:PointGoal-v0", scenario="homes", render_mode="human")
    env.reset(seed=0, options={"seed": 1})
    with wait_for_page(env, capsys) as page:
        page.wait_for_text("home of 264 m2")
        before = set(page.nodes)
        env.reset(options={"seed": 2})
        page.wait_for_text("home of 46 m2")
        assert set(page.nodes) != before
    env.close()


def test_a_missing_cockpit_is_reported(monkeypatch):
    monkeypatch.delitem(sys.modules, "home_service_gym.browser_window", raising=False)
    monkeypatch.setitem(sys.modules, "cockpit.page.server", None)
    env = gymnasium.make("home_service_gym:PointGoal-v0", render_mode="human")
    with pytest.raises(SettingsError, match="needs the cockpit: ./scripts/setup.sh --web"):
        env.reset(seed=0)
    env.close()
