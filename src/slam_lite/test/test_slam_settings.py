from pathlib import Path

import pytest
import yaml

from planar import SettingsError
from planar.config.parameters import official_names, parameters_of
from planar.config.settings import settings_from
from slam_lite.config import WITHOUT_EFFECT, NodeSettings

CONFIG = Path(__file__).resolve().parents[1] / "config"

# gmapping 1.4; there maxRange and maxUrange default to the scan's range, for which 0 stands here
OFFICIAL = {
    "throttle_scans": 1,
    "base_frame": "base_link",
    "map_frame": "map",
    "odom_frame": "odom",
    "transform_publish_period": 0.05,
    "map_update_interval": 5.0,
    "srr": 0.1,
    "srt": 0.2,
    "str": 0.1,
    "stt": 0.2,
    "xmin": -100.0,
    "ymin": -100.0,
    "xmax": 100.0,
    "ymax": 100.0,
    "delta": 0.05,
    "occ_thresh": 0.25,
}


def test_every_official_parameter_has_its_official_default():
    ours = {each.name: each.default for each in parameters_of(NodeSettings)}
    assert {name: ours.get(name) for name in OFFICIAL} == OFFICIAL


def test_no_used_parameter_is_listed_as_without_effect():
    assert not set(WITHOUT_EFFECT) & set(official_names(NodeSettings))


def test_the_turtlebot_preset_is_valid():
    preset = yaml.safe_load((CONFIG / "turtlebot.yaml").read_text())
    settings, unknown = settings_from(NodeSettings, preset, official_names(NodeSettings))
    assert unknown == []
    assert settings.extent == (-1.0, -1.0, 1.0, 1.0)


@pytest.mark.parametrize(
    "values, complaint",
    [
        ({"delta": 0.0}, "/slam_gmapping/delta must be between"),
        ({"srr": -1.0}, "/slam_gmapping/srr must be"),
        ({"maxRange": 5.0, "maxUrange": 6.0}, "/slam_gmapping/maxUrange must be at most maxRange"),
        ({"xmin": 2.0, "xmax": 1.0}, "/slam_gmapping/xmin must be less than xmax"),
        ({"localization_only": True}, "/slam_gmapping/localization_only must be used with state"),
    ],
)
def test_an_invalid_value_is_refused_by_its_official_name(values, complaint):
    with pytest.raises(SettingsError, match=complaint):
        settings_from(NodeSettings, values, official_names(NodeSettings), where="/slam_gmapping/")


def test_old_names_of_parameters_are_accepted_with_a_warning():
    old = {"key_distance": 0.3, "key_angle": 0.4, "window_keys": 7}
    names = official_names(NodeSettings)
    with pytest.warns(FutureWarning) as warned:
        settings, unknown = settings_from(NodeSettings, old, names, where="/slam_gmapping/")
    assert [str(warning.message) for warning in warned] == [
        "/slam_gmapping/key_distance is deprecated; use keyframe_distance",
        "/slam_gmapping/key_angle is deprecated; use keyframe_angle",
        "/slam_gmapping/window_keys is deprecated; use window_keyframes",
    ]
    assert unknown == []
    assert (settings.keyframe_distance, settings.keyframe_angle, settings.window_keyframes) == (0.3, 0.4, 7)
