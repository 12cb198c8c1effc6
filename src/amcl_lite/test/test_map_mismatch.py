"""A map that no scan has ever fitted is suspected, once."""

from amcl_lite.recovery.quality import MISMATCH_SECONDS, MapMismatchMonitor, ScanQuality


def alarm_times(*probabilities):
    """Return the seconds at which the monitor warns, given one probability per second."""
    alarm = MapMismatchMonitor()
    qualities = [ScanQuality(probability, 0.0, 0.0, 1.0) for probability in probabilities]
    return [second for second, quality in enumerate(qualities) if alarm.add(quality, float(second))]


def test_a_map_that_nothing_fits_is_suspected_once():
    assert alarm_times(*[0.1] * 30) == [int(MISMATCH_SECONDS) + 1]


def test_a_robot_that_is_lost_later_has_a_map_that_fits():
    assert alarm_times(0.1, 0.9, *[0.1] * 30) == []


def test_scans_before_a_jump_back_of_time_do_not_count():
    alarm = MapMismatchMonitor()
    assert not alarm.add(ScanQuality(0.1, 0.0, 0.0, 1.0), 100.0)
    assert not alarm.add(ScanQuality(0.1, 0.0, 0.0, 1.0), 0.0)
    assert alarm.add(ScanQuality(0.1, 0.0, 0.0, 1.0), MISMATCH_SECONDS + 0.1)
