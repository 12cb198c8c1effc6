"""The journal: nothing is lost, whatever happens to the process or the disk."""

import json
import os
import sqlite3
import subprocess
import sys
from dataclasses import replace

import pytest
from service_bench import NOW, Bench

from service.errors import JournalError
from service.execution.robot import RobotInputs, StopRobot
from service.host import ServiceHost, submit, task
from service.journal import VERSION, Journal, JournalLimits
from service.task import TaskStatus
from service.task_book import Changes, JournalEntry


def journaled(path, **options):
    journal = Journal(path)
    return journal, Bench(journal.restore(), store=journal.store, find_ended=journal.ended_task, **options)


def test_a_journal_restores_what_was_stored(tmp_path):
    journal, bench = journaled(tmp_path / "journal.db")
    bench.send("deliver cup from kitchen to desk", by="+1h", priority=2, requester="anna", labels=["a"])
    bench.send("patrol desk hall 2 times")
    bench.send("go hall", repeat="0 8 * * *")
    bench.run(60.0)
    book = bench.service.book
    journal.close()
    again = Journal(tmp_path / "journal.db").restore()
    assert [replace(task, estimate=None) for task in book.tasks.values()] == list(again.tasks)
    assert (dict(again.objects), list(again.series)) == (book.objects, list(book.series.values()))
    assert again.next_number == book.next_number
    assert again.robot is not None and again.latest > NOW


def test_ended_tasks_are_found(tmp_path):
    journal, bench = journaled(tmp_path / "journal.db")
    (task,) = bench.finish(bench.send("go desk", id="one"))
    assert journal.ended_task("one") == replace(task, estimate=None)
    assert journal.ended_task("two") is None
    assert bench.send("go desk", id="one").status is TaskStatus.COMPLETED, "it is not done again"
    assert [task.id for task in journal.ended_tasks()] == ["one"]


def test_each_commit_waits_for_the_disk(tmp_path):
    journal = Journal(tmp_path / "journal.db")
    assert next(journal._rows("PRAGMA synchronous"))[0] == 2
    assert next(journal._rows("PRAGMA journal_mode"))[0] == "wal"


def test_a_log_cut_off_anywhere_restores_a_state_that_was_committed(tmp_path):
    """Power is lost: the end of the write-ahead log is missing, or was never written."""
    journal, bench = journaled(tmp_path / "journal.db")
    task = bench.send("deliver cup from kitchen to desk")
    bench.keep()
    states = [(0, False)]
    store = bench._store
    bench._store = lambda changes, number: (
        store(changes, number),
        states.append(
            (bench.service.book.tasks[task.id].step, True)
            if task.id in bench.service.book.tasks
            else (4, True)
        ),
    )
    bench.finish(task)
    database, log = tmp_path / "journal.db", tmp_path / "journal.db-wal"
    content, tail = database.read_bytes(), log.read_bytes()
    journal.close()
    seen = set()
    for number in range(0, len(tail), max(1, len(tail) // 60)):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "journal.db").write_bytes(content)
        (folder / "journal.db-wal").write_bytes(tail[:number] + b"\xff" * (100 if number % 2 else 0))
        copy = Journal(folder / "journal.db")
        snapshot, ended = copy.restore(), copy.ended_task(task.id)
        copy.close()
        if not snapshot.tasks:
            seen.add("ended" if ended else "nothing")
            continue
        step, cup = snapshot.tasks[0].step, snapshot.objects["cup"]
        assert (cup.carried_by == task.id) == (step in (2, 3)), "what is carried is known"
        assert cup.place == {0: "kitchen", 1: "kitchen", 2: None, 3: None}[step]
        seen.add(step)
    assert {0, 1, 2, 3} <= seen


def test_history_is_bounded(tmp_path):
    path = tmp_path / "journal.db"
    journal = Journal(path, JournalLimits(ended_tasks=20, log_entries=50))
    bench = Bench(store=journal.store, find_ended=journal.ended_task)
    sizes = []
    for number in range(300):
        task = bench.send("go desk")
        bench.keep()
        bench.service.cancel(task.id, bench.now)
        bench.keep()
        if number % 100 == 99:
            journal._execute("PRAGMA wal_checkpoint(TRUNCATE)")
            sizes.append(path.stat().st_size)
    assert len(journal.ended_tasks()) == 20
    assert [entry.task for _, entry in journal.log_after(0)][-1] == "300"
    assert len(journal.log_after(0)) == 50
    assert sizes[2] <= sizes[1]


def test_a_journal_of_another_version_is_refused(tmp_path):
    path = tmp_path / "journal.db"
    Journal(path).close()
    connection = sqlite3.connect(path)
    connection.execute(f"PRAGMA user_version = {VERSION + 1}")
    connection.close()
    with pytest.raises(JournalError, match=f"of version {VERSION + 1}, expected {VERSION}"):
        Journal(path)


def test_another_database_is_refused(tmp_path):
    path = tmp_path / "journal.db"
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE address (name)")
    connection.close()
    with pytest.raises(JournalError, match="is no journal of this service"):
        Journal(path)


@pytest.mark.parametrize("keep", [10, 1000, 5000, 20_000])
def test_a_truncated_journal_is_refused(tmp_path, keep):
    path = tmp_path / "journal.db"
    journal, bench = journaled(path)
    bench.finish(bench.send("deliver cup from kitchen to desk"))
    journal.close()
    path.write_bytes(path.read_bytes()[:keep])
    with pytest.raises(JournalError, match="the journal is damaged .*; move it away"):
        Journal(path).restore()


def test_a_file_of_something_else_is_refused(tmp_path):
    path = tmp_path / "journal.db"
    path.write_bytes(b"no database at all" * 100)
    with pytest.raises(JournalError, match="the journal is damaged"):
        Journal(path)


def test_a_journal_is_used_by_one_service(tmp_path):
    first = Journal(tmp_path / "journal.db")
    with pytest.raises(JournalError, match="another service uses this journal"):
        Journal(tmp_path / "journal.db")
    first.close()
    Journal(tmp_path / "journal.db").close()


def test_history_is_read_beside_a_running_service(tmp_path):
    journal, bench = journaled(tmp_path / "journal.db")
    bench.finish(bench.send("go desk"))
    assert len(Journal(tmp_path / "journal.db", is_reader=True).ended_tasks()) == 1
    with pytest.raises(JournalError):
        Journal(tmp_path / "none.db", is_reader=True)


def host_of(path, limits=JournalLimits()):
    def make(journal):
        return Bench(journal.restore(), find_ended=journal.ended_task).service

    return ServiceHost(path, make, limits=limits)


def test_a_full_disk_stops_the_robot_and_refuses_requests(tmp_path):
    host = host_of(tmp_path / "journal.db", JournalLimits(pages=16))
    robot = RobotInputs(Bench().robot.pose, 1.0, True)
    accepted, refused, order = [], None, None
    for number in range(2000):
        answer = host.call(submit({"text": "go desk", "labels": ["x" * 200] * 20, "id": f"t-{number}"}))
        order = host.cycle(NOW, robot)
        if answer.exception() is not None:
            refused = answer.exception()
            break
        accepted.append(answer.result()["booking"]["id"])
    assert isinstance(refused, JournalError)
    assert "free some space on the disk" in str(refused)
    assert isinstance(order, StopRobot)
    later = host.call(submit({"text": "go hall"}))
    assert host.cycle(NOW, robot) is None
    assert isinstance(later.exception(), JournalError)
    host.close()
    assert [task.id for task in Journal(tmp_path / "journal.db").restore().tasks] == accepted


def test_a_task_that_ends_while_it_is_asked_for_is_answered(tmp_path):
    host, bench = host_of(tmp_path / "journal.db"), Bench()
    host.call(submit({"text": "wait 0", "id": "short"}))
    statuses = []
    for number in range(6):
        answer = host.call(task("short")) if number else None
        host.cycle(NOW + number, bench.robot.inputs(NOW + number))
        statuses += [answer.result()["status"]] if answer else []
    assert statuses[-1] == "completed"


@pytest.mark.skipif(os.geteuid() == 0, reason="root writes anywhere")
def test_a_read_only_journal_is_refused(tmp_path):
    Journal(tmp_path / "journal.db").close()
    (tmp_path / "journal.db").chmod(0o444)
    with pytest.raises(JournalError, match="make the file and its folder writable"):
        Journal(tmp_path / "journal.db").store(Changes(log=[JournalEntry(0.0, "", "", "")]), 1)


KILLED = """
import json, os, sys
from pathlib import Path
from service.journal import Journal
from service.task_book import Changes, JournalEntry
journal = Journal(Path(sys.argv[1]))
for number in range(100000):
    journal.store(Changes(log=[JournalEntry(float(number), "test", "", "")]), number)
    print(number, flush=True)
"""


def test_what_was_stored_survives_a_kill(tmp_path):
    command = [sys.executable, "-c", KILLED, str(tmp_path / "journal.db")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        for _ in range(40):
            stored = int(process.stdout.readline())
        process.kill()
        rest = process.stdout.read().split()
    stored = int(rest[-1]) if rest and rest[-1].isdigit() else stored
    entries = Journal(tmp_path / "journal.db").log_after(0, 10**6)
    assert len(entries) in (stored + 1, stored + 2)
    assert json.dumps([entry.stamp for _, entry in entries[:40]]) == json.dumps([float(n) for n in range(40)])
