from planar.elapsed_time import ElapsedTime


def test_a_jump_back_of_the_clock_counts_as_no_time():
    elapsed = ElapsedTime()
    assert [elapsed.update(now) for now in (50.0, 50.5, 60.0, 10.0, 10.0, 12.0)] == [
        0.0,
        0.5,
        10.0,
        10.0,
        10.0,
        12.0,
    ]
