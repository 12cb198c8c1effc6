from planar.elapsed_time import ElapsedTime


def test_what_a_clock_is_set_back_by_has_not_passed():
    elapsed = ElapsedTime()
    assert [elapsed.update(now) for now in (50.0, 50.5, 60.0, 10.0, 10.0, 12.0)] == [
        0.0,
        0.5,
        10.0,
        10.0,
        10.0,
        12.0,
    ]
