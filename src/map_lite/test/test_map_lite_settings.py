import pytest

from map_lite.config import SaverSettings, ServerSettings
from planar import SettingsError


def test_the_defaults_are_the_official_ones():
    assert (SaverSettings().occupied_at, SaverSettings().free_at) == (65, 25)
    assert (ServerSettings().occupied_thresh, ServerSettings().free_thresh) == (0.65, 0.196)


@pytest.mark.parametrize("occupied_at, free_at", [(20, 20), (0, 0), (101, 25), (65, -1)])
def test_invalid_thresholds_are_refused(occupied_at, free_at):
    with pytest.raises(SettingsError):
        SaverSettings(occupied_at, free_at)
