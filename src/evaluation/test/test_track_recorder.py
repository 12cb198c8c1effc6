from evaluation.consumers.track_recorder import TrackRecorder
from evaluation.event_stream import EventStream
from evaluation.events import BodiesTouched, EstimateUpdated, TruthUpdated
from planar import Pose2


def test_poses_errors_and_contacts_are_kept():
    recorder, events = TrackRecorder(), EventStream()
    recorder.attach(events)
    for stamp in (1.0, 2.0):
        events.publish(TruthUpdated(stamp, Pose2(stamp, 0.5, 0.1)))
        events.publish(EstimateUpdated(stamp, Pose2(stamp, 0.8)))
        events.publish(BodiesTouched(stamp, ("sofa", "wall")))
    assert recorder.trajectory == [(1.0, 1.0, 0.5, 0.1), (2.0, 2.0, 0.5, 0.1)]
    assert [round(error, 9) for error in recorder.localization_errors] == [0.3, 0.3]
    assert recorder.collisions == ["sofa", "wall"] * 2
