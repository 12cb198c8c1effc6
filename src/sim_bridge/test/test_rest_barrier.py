"""Simulated time passes beside other people's nodes when they rest, and never waits for ever."""

import itertools
import shutil
import subprocess
import sys
import time

import pytest

from sim_bridge.rest.barrier import (
    LOOK_SECONDS,
    MOST_NEWS,
    OTHERS_PATIENCE_SECONDS,
    RECOVERY_SECONDS,
    AwaitedRest,
    RestBarrier,
)
from sim_bridge.rest.threads import (
    WATCH_SECONDS,
    WATCHES,
    KernelThreads,
    PollingThreads,
    ProcessThreads,
    has_ended,
    is_native,
)

QUIET, PATIENCE, LOOK = 0.002, 5.0, 0.0005


class Run:
    """A simulation with nodes that are busy until given wall times."""

    AWAITED = frozenset({"amcl", "move_base", "planner", "spinning"})
    from_first_rest = False

    def __init__(self, **busy_until):
        self.barrier = RestBarrier(PATIENCE)
        self.busy_until, self.wall = busy_until, 0.0

    def step(self, news_until=0.0):
        """Wait until the nodes have rested; return the wall time that it took."""
        begun = self.wall
        while not self.look(news_until):
            self.wall += LOOK
            assert self.wall - begun < 60.0, "the simulation stands still"
        return self.wall - begun

    def look(self, news_until=0.0):
        rest = AwaitedRest(self._nodes(), self.AWAITED, QUIET, self.from_first_rest)
        return self.barrier.is_passed(self.wall, rest, self.wall < news_until)

    def _nodes(self):
        return {name: lambda until=until: self.wall >= until for name, until in self.busy_until.items()}


def test_time_passes_when_all_nodes_have_rested_for_a_while():
    run = Run(amcl=0.010, move_base=0.030)
    assert run.step() == pytest.approx(0.030 + QUIET, abs=2 * LOOK)
    assert run.step() == pytest.approx(QUIET, abs=2 * LOOK)


def test_a_node_without_a_name_is_waited_for():
    """The master has none."""
    run = Run()
    run.busy_until[""] = 0.010
    assert run.step() == pytest.approx(0.010 + QUIET, abs=2 * LOOK)


def test_a_loop_that_looks_at_the_clock_does_not_prolong_the_wait():
    """Seen running at each third look, as a loop that sleeps for a millisecond."""
    barrier, looks, wall = RestBarrier(PATIENCE), itertools.count(), 0.0
    nodes = {"move_base": lambda: next(looks) % 3 != 1}
    while not barrier.is_passed(wall, AwaitedRest(nodes, ("move_base",), QUIET), False):
        wall += LOOK
        assert wall < 0.05
    assert wall <= QUIET + 2 * LOOK


def test_a_quiet_time_may_begin_with_the_first_rest():
    """A loop that looks at the clock may have done so just before the receiver of the time came to run."""
    run = Run(amcl=0.010)
    run.from_first_rest = True
    assert 0.010 + QUIET <= run.step() <= 0.010 + QUIET + 2 * LOOK
    assert QUIET <= run.step() <= QUIET + 3 * LOOK


def test_it_ends_when_all_loops_have_looked_at_the_clock():
    barrier, wall, looked = RestBarrier(PATIENCE), 0.0, []
    rest = AwaitedRest({"amcl": lambda: True}, ("amcl",), 9.0, True, lambda: bool(looked))
    while not barrier.is_passed(wall, rest, False):
        wall += LOOK
        if wall > 0.5:
            looked.append(wall)
    assert 0.5 < wall <= 0.5 + 3 * LOOK


def test_a_message_that_arrives_then_may_have_them_work_again():
    barrier, wall, sent = RestBarrier(PATIENCE), 0.0, []
    rest = AwaitedRest({"amcl": lambda: True}, ("amcl",), 9.0, True, lambda: True)
    while not barrier.is_passed(wall, rest, len(sent) < 8):
        sent.append(wall)
        wall += LOOK
    assert wall >= sent[7] + LOOK_SECONDS


def test_such_a_quiet_time_begins_again_after_a_node_was_busy_twice():
    barrier, looks, wall = RestBarrier(PATIENCE), iter([True, False, False, True, *[True] * 99]), 0.0
    rest = AwaitedRest({"amcl": lambda: next(looks)}, ("amcl",), QUIET, from_first_rest=True)
    while not barrier.is_passed(wall, rest, False):
        wall += LOOK
    assert wall >= 4 * LOOK + QUIET


def test_a_message_that_arrives_is_processed_before_time_passes():
    run = Run(amcl=0.0)
    assert run.step(news_until=0.004) == pytest.approx(0.004 + QUIET, abs=2 * LOOK)


def test_a_node_that_floods_does_not_stop_time():
    run = Run(amcl=0.0)
    assert run.step(news_until=1000.0) < MOST_NEWS * LOOK + QUIET + 2 * LOOK


def test_a_node_that_never_rests_is_given_up_and_the_others_are_waited_for():
    run = Run(spinning=1e9, amcl=0.0)
    assert run.step() == pytest.approx(PATIENCE, abs=0.01)
    assert [*run.barrier.given_up] == ["spinning"]
    run.busy_until["amcl"] = run.wall + 0.02
    assert run.step() == pytest.approx(0.02 + QUIET, abs=2 * LOOK)


def test_a_further_node_that_never_rests_is_given_up_soon():
    run = Run(amcl=0.0, viewer=1e9)
    assert run.step() == pytest.approx(OTHERS_PATIENCE_SECONDS, abs=0.01)
    assert run.step() == pytest.approx(QUIET, abs=2 * LOOK)


@pytest.mark.parametrize("name", ["planner", "viewer"])
def test_a_node_is_not_given_up_because_the_machine_stands_still(name):
    """All processes of a virtual machine stop for seconds, or get little time beside others."""
    run = Run(**{name: 2.0 * PATIENCE + 0.15})
    for stall in (PATIENCE + 0.1, PATIENCE):
        run.look()
        run.wall += LOOK
        run.look()
        run.wall += stall
    assert run.step() == pytest.approx(0.05, abs=QUIET)
    assert not run.barrier.given_up


def test_a_node_that_is_late_once_is_waited_for_again():
    run = Run(planner=PATIENCE + 1.0)
    run.step()
    assert [*run.barrier.given_up] == ["planner"]
    run.wall = PATIENCE + 1.0 + LOOK
    run.step()
    run.wall += RECOVERY_SECONDS + 1.5
    run.step()
    assert not run.barrier.given_up


def test_a_node_that_was_late_is_waited_for_again_although_the_clock_wakes_it():
    run = Run(planner=1e9)
    run.step()
    rests = [True, True, False]
    for look in range(int(2.5 * RECOVERY_SECONDS / LOOK)):
        run.wall += LOOK
        nodes = {"planner": lambda look=look: rests[look % 3]}
        run.barrier.is_passed(run.wall, AwaitedRest(nodes, run.AWAITED, QUIET), False)
    assert not run.barrier.given_up


def test_a_node_that_has_ended_is_dropped():
    run = Run(spinning=1e9)
    run.step()
    del run.busy_until["spinning"]
    run.step()
    assert not run.barrier.given_up


def test_time_that_restarts_begins_a_new_barrier():
    run = Run(amcl=1.0)
    assert not run.look()
    run.barrier.reset()
    run.wall, run.busy_until["amcl"] = 1.0, 1.0
    assert run.step() == pytest.approx(QUIET, abs=LOOK)


SPIN = "while True: pass"
REST = "import threading, time; threading.Thread(target=time.sleep, args=(60,)).start(); time.sleep(60)"

# On a line, a thread that waits ends, and one that computes begins.
REPLACED = """
import sys, threading, time
end = threading.Event()
waiting = threading.Thread(target=end.wait)
waiting.start()
sys.stdin.readline()
end.set()
waiting.join()
threading.Thread(target=lambda: [None for _ in iter(int, 1)]).start()
print(flush=True)
time.sleep(60)
"""


@pytest.fixture
def program():
    started = []

    def start(code):
        started.append(
            subprocess.Popen(
                [sys.executable, "-c", f"print(flush=True)\n{code}"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
        )
        started[-1].stdout.readline()
        return started[-1]

    yield start
    for process in started:
        process.kill()
        process.wait()


def rests(threads, wanted):
    """Whether the threads are seen as wanted within some time."""
    end = time.monotonic() + 10.0
    while time.monotonic() < end:
        if threads.are_resting() == wanted:
            return True
        time.sleep(0.001)
    return False


def test_threads_that_sleep_rest(program):
    threads = ProcessThreads(program(REST).pid)
    assert rests(threads, True)
    threads.close()


def test_a_thread_that_computes_does_not_rest(program):
    assert rests(ProcessThreads(program(SPIN).pid), False)


def test_a_thread_that_begins_as_another_ends_is_looked_at(program):
    process = program(REPLACED)
    threads = ProcessThreads(process.pid)
    assert rests(threads, True)
    process.stdin.write("\n")
    process.stdin.flush()
    process.stdout.readline()
    assert rests(threads, False)
    threads.close()


def test_a_thread_that_hands_over_to_one_that_was_read_before_hides_it_once(tmp_path, monkeypatch):
    for name in ("1", "2"):
        (tmp_path / "7" / "task" / name).mkdir(parents=True)
    running, read = {"1"}, []

    def is_waiting(_, name):
        read.append(name)
        if len(read) == 1:
            running.symmetric_difference_update({"1", "2"})  # after this thread was read
            return True
        return name not in running

    monkeypatch.setattr(ProcessThreads, "_is_waiting", is_waiting)
    monkeypatch.setattr("os.listdir", lambda _: ["1", "2"])
    threads = ProcessThreads(7, tmp_path)
    assert [threads.are_resting(), threads.are_resting()] == [True, False]


@pytest.mark.parametrize(("program", "is_at_rest"), [("/usr/bin/python3", False), ("/opt/ros/amcl", True)])
def test_threads_that_wait_at_each_look_but_take_time_in_between_do_not_rest(tmp_path, program, is_at_rest):
    """Those of roscpp may look at the clock in between."""
    stat = tmp_path / "7" / "task" / "7" / "stat"
    stat.parent.mkdir(parents=True)
    stat.write_bytes(b"7 (node) S 1")
    (tmp_path / "7" / "exe").symlink_to(program)
    used = [0.0, 0.8 * LOOK, 0.82 * LOOK, 0.82 * LOOK]
    times = iter((number * LOOK, seconds) for number, seconds in enumerate(used))
    threads = ProcessThreads(7, tmp_path, lambda: next(times))
    assert [threads.are_resting() for _ in range(4)] == [True, False, is_at_rest, True]


# Eight threads that wait for ever, and with "poll" one that looks at a clock each millisecond.
WAIT_OR_POLL = r"""
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
int main(int count, char**)
{
  std::mutex mutex;
  std::condition_variable never;
  using Lock = std::unique_lock<std::mutex>;
  const auto wait = [&] { Lock lock(mutex); never.wait(lock); };
  const auto poll = [&] {
    while (true) { Lock lock(mutex); never.wait_for(lock, std::chrono::milliseconds(1)); }
  };
  for (int i = 0; i < 8; i++) std::thread(wait).detach();
  if (count > 1) std::thread(poll).detach();
  std::puts("");
  std::fflush(stdout);
  wait();
}
"""


@pytest.fixture(scope="module")
def native_program(tmp_path_factory):
    if shutil.which("g++") is None:
        pytest.skip("no compiler")
    folder = tmp_path_factory.mktemp("native")
    (folder / "node.cpp").write_text(WAIT_OR_POLL)
    command = ["g++", "-std=c++17", "-pthread", str(folder / "node.cpp"), "-o", str(folder / "node")]
    subprocess.run(command, check=True)
    return folder / "node"


@pytest.mark.parametrize(("arguments", "polls"), [([], False), (["poll"], True)])
def test_threads_that_look_at_the_clock_are_learned(native_program, arguments, polls):
    process = subprocess.Popen([str(native_program), *arguments], stdout=subprocess.PIPE)
    try:
        process.stdout.readline()
        threads = ProcessThreads(process.pid)
        assert threads.may_poll(), "nothing is known yet"
        for _ in range(2 * WATCHES):
            known = threads.may_poll()
            while not threads.are_resting():
                time.sleep(LOOK)
            time.sleep(1.2 * WATCH_SECONDS)
            threads.are_resting()
        assert known == polls
        threads.close()
    finally:
        process.kill()
        process.wait()


def test_a_thread_that_looks_at_the_clock_has_when_it_has_run_since_all_rested(tmp_path):
    task = tmp_path / "7" / "task"
    for name, call in (("7", "230 0x1"), ("8", "202 0x1")):
        (task / name).mkdir(parents=True)
        (task / name / "syscall").write_text(call)
        (task / name / "schedstat").write_text("1 1 5")
        (task / name / "stat").write_text(f"{name} (node) S 2")
    (tmp_path / "7" / "exe").symlink_to("/opt/ros/lib/add_markers")
    threads = ProcessThreads(7, tmp_path, times=lambda: (0.0, 0.0))
    for _ in range(WATCHES):  # thread 8 is learned not to
        threads.may_poll()
        for wall in (1.0, 2.0):
            threads._polling.watch(wall, ["7", "8"])
        threads.begin_barrier()
    threads.may_poll()
    assert not threads.have_polled(), "no look has found it at rest"
    assert threads.are_resting()
    assert not threads.have_polled()
    (task / "8" / "schedstat").write_text("1 1 6")
    assert not threads.have_polled()
    (task / "7" / "schedstat").write_text("1 1 6")
    assert threads.have_polled()
    threads.close()


def test_a_node_that_ends_between_two_looks_at_its_threads_waits_for_no_clock(tmp_path):
    (tmp_path / "7" / "task" / "7").mkdir(parents=True)
    (tmp_path / "7" / "exe").symlink_to("/opt/ros/lib/pick_objects")
    threads = ProcessThreads(7, tmp_path)
    assert threads.may_poll()
    shutil.rmtree(tmp_path / "7")
    assert not threads.may_poll()
    with pytest.raises(ProcessLookupError):
        threads.are_resting()


def test_a_thread_that_runs_beside_one_that_looks_at_the_clock_is_noticed(tmp_path):
    """One that was read before may have handed it work for a shorter time than looks at the clock take."""
    for name in ("8", "9"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "syscall").write_text("202 0x1")
        (tmp_path / name / "schedstat").write_text("1 1 0")
    threads = PollingThreads(tmp_path)
    for step in range(2 * WATCHES):
        threads.may_be_any(["8", "9"])
        for look in range(2):
            (tmp_path / "9" / "schedstat").write_text(f"1 1 {step}{look}")
            threads.watch(step + 0.5 * look, ["8", "9"])
        assert not threads.have_others_run()
        threads.stop_watching()
    assert threads.may_be_any(["8", "9"])
    threads.watch(100.0, ["8", "9"])
    (tmp_path / "8" / "schedstat").write_text("1 1 1")
    assert [threads.have_others_run(), threads.have_others_run()] == [True, False]
    threads.stop_watching()
    (tmp_path / "8" / "syscall").write_text("230 0x1")
    threads.may_be_any(["8", "9"])
    threads.watch(101.0, ["8", "9"])
    (tmp_path / "8" / "schedstat").write_text("1 1 2")
    assert not threads.have_others_run(), "it sleeps in simulated time"


def test_a_thread_that_runs_between_two_barriers_only_does_not_look_at_the_clock(tmp_path):
    (tmp_path / "8").mkdir()
    threads, wall = PollingThreads(tmp_path), 0.0
    for barrier in range(2 * WATCHES):
        (tmp_path / "8" / "schedstat").write_text(f"1 1 {barrier}")
        (tmp_path / "8" / "syscall").write_text("202 0x1")
        polls = threads.may_be_any(["8"])
        for _ in range(2):
            wall += 1.5 * WATCH_SECONDS
            threads.watch(wall, ["8"])
        threads.stop_watching()
    assert not polls
    (tmp_path / "8" / "syscall").write_text("230 0x1")
    assert threads.may_be_any(["8"]), "it sleeps"


def test_the_threads_of_a_process_with_the_library_take_turns(tmp_path):
    (tmp_path / "7").mkdir()
    (tmp_path / "7" / "environ").write_bytes(b"HOME=/root\0LD_PRELOAD=/ws/devel/lib/libordered_wake.so\0")
    assert ProcessThreads(7, tmp_path).take_turns
    assert not ProcessThreads(8, tmp_path).take_turns


def test_the_kernel_delivers_messages_while_one_of_its_threads_runs(tmp_path):
    for number, name in (("14", "ksoftirqd/0"), ("22", "ksoftirqd/1"), ("30", "node")):
        (tmp_path / number).mkdir()
        (tmp_path / number / "comm").write_text(f"{name}\n")
        (tmp_path / number / "stat").write_text(f"{number} ({name}) S 2")
    threads = KernelThreads(tmp_path)
    assert threads.are_resting()
    (tmp_path / "30" / "stat").write_text("30 (node) R 2")
    assert threads.are_resting()
    (tmp_path / "22" / "stat").write_text("22 (ksoftirqd/1) R 2")
    assert not threads.are_resting()


def test_where_its_threads_are_not_visible_the_kernel_is_not_waited_for(tmp_path):
    assert KernelThreads(tmp_path).are_resting()


def test_an_ended_process_is_noticed(program):
    process = program(REST)
    threads = ProcessThreads(process.pid)
    threads.are_resting()
    process.kill()
    process.wait()
    with pytest.raises(ProcessLookupError):
        threads.are_resting()


def test_a_process_whose_end_its_parent_has_not_noticed_has_ended(program):
    process = program(REST)
    assert not has_ended(process.pid)
    process.kill()
    end = time.monotonic() + 10.0
    while not has_ended(process.pid) and time.monotonic() < end:
        time.sleep(0.001)
    assert has_ended(process.pid)
    process.wait()
    assert has_ended(process.pid)


def test_a_program_of_python_is_not_native(program):
    assert not is_native(program(REST).pid)
    shell = subprocess.Popen(["sleep", "60"])
    try:
        assert is_native(shell.pid)
    finally:
        shell.kill()
        shell.wait()
    assert not is_native(shell.pid), "it has ended"
