#!/usr/bin/env python3
"""Kill the service at random moments and check that nothing is lost, doubled or reported wrongly.

python3 tests/benchmarks/service_kills.py [--kills 1000] [--seed 0]

The service, with its journal, runs in a process that is killed with SIGKILL after a random time, at whatever
instruction it is, and started again. The robot, the objects and the clients live in this process. They know
only what the service has published after it was journaled, as move_base, markers and HTTP clients do; a
client that got no answer sends its request again under the same id. Checked:

* each accepted request is in the journal, open or ended, and none ends twice
* each object is picked up and set down once for each request that has moved it, in this order
* where an object is according to the journal is where the world has it, and so is what the robot carries
"""

import argparse
import multiprocessing
import os
import signal
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

from evaluation.options import HOME_MAP, ROOT
from pick_objects import load_mission
from planar import Pose2, load_map
from service.day.kinematic_robot import KinematicRobot, KinematicSettings
from service.host import ServiceHost, submit
from service.journal import Journal
from service.plan.rollout import PlanningModel
from service.plan.travel_times import GridTravelTimes
from service.request_service import RequestService, Site
from service.requests.parser import Knowledge
from service.task import TaskStatus

START = 1796025600.0
DOCK = Pose2(0.5, -3.0)
# Simulated time of a cycle [s]. A process is killed a random time after a random number of cycles; some while
# they start.
CYCLE, MOST_CYCLES, LONGEST_DELAY, EARLY_SHARE = 2.0, 30, 0.02, 0.2
OBJECTS = 5
# Share of cycles in which a request is sent: as many as the robot can carry out.
NEW_SHARE = 0.04


def make_site():
    """Return the home."""
    places = dict(load_mission(ROOT / "map/mission.yaml").places)
    travel = GridTravelTimes(load_map(HOME_MAP))
    return Site(places, PlanningModel(travel, dock=DOCK), Knowledge(tuple(places), True))


def serve(path, site, pipe):
    """Run the service: a cycle for each message, answered with what may be known outside."""
    host = ServiceHost(
        path, lambda journal: RequestService(site, snapshot=journal.restore(), find_ended=journal.ended_task)
    )
    while True:
        now, robot, event, documents = pipe.recv()
        answers = [host.call(submit(document)) for document in documents]
        order = host.cycle(now, robot, event)
        accepted = [answer.result()["booking"]["id"] for answer in answers if answer.exception() is None]
        refused = [str(answer.exception()) for answer in answers if answer.exception() is not None]
        assert host.service is not None, "the journal can be written"
        pipe.send((order, accepted, refused, dict(host.service.book.objects)))


class World:
    """What the robot has really done to the objects, by what was published."""

    def __init__(self):
        self.states, self.deeds, self.faults = {}, [], []

    def publish(self, objects):
        """Move objects to where they are published to be."""
        for name, state in objects.items():
            before = self.states.get(name)
            self.states[name] = state
            if before is None or before == state:
                continue
            if state.carried_by and not before.carried_by:
                self.deeds.append(("picked up", name, state.carried_by))
                if any(each.carried_by for other, each in self.states.items() if other != name):
                    self.faults.append(f"{name}: picked up while another object was on board")
            elif before.carried_by and not state.carried_by:
                self.deeds.append(("set down", name, before.carried_by, state.place))
            elif before.place != state.place:
                self.faults.append(f"{name}: moved from {before.place} to {state.place} by nobody")


class Client:
    """Sends deliveries of objects, each again until it is answered."""

    def __init__(self, places, rng):
        self._places, self._rng = list(places), rng
        self._where = {f"object{n}": str(rng.choice(self._places)) for n in range(OBJECTS)}
        self.waiting, self.accepted, self.sent = {}, {}, 0

    def documents(self):
        """Return what has to be sent; now and then a new delivery or another request."""
        if len(self.waiting) == 0 and self._rng.random() < NEW_SHARE:
            self.sent += 1
            name = f"client-{self.sent}"
            if self._rng.random() < 0.3:
                self.waiting[name] = {
                    "id": name,
                    "text": f"go {self._rng.choice(self._places)}",
                    "priority": 3,
                }
            else:
                self.waiting[name] = {"id": name, **self._delivery()}
        return list(self.waiting.values())

    def _delivery(self):
        item = f"object{self._rng.integers(OBJECTS)}"
        source = self._where[item]
        self._where[item] = target = str(self._rng.choice([each for each in self._places if each != source]))
        return {"category": "deliver", "description": {"object": item, "from": source, "to": target}}

    def answer(self, accepted):
        """Note which requests were accepted."""
        for name in accepted:
            if name in self.waiting:
                self.accepted[name] = self.waiting.pop(name)


class Campaign:
    """Kills and starts the service until enough kills are made, then lets it finish."""

    def __init__(self, folder, seed):
        self.path, self.site, self.rng = folder / "journal.db", make_site(), np.random.default_rng(seed)
        settings = KinematicSettings(spread=0.1, failure=0.0, docking_failure=0.0)
        self.robot = KinematicRobot(self.site.model.travel, DOCK, np.random.default_rng(seed + 1), settings)
        self.client, self.world = Client(self.site.places, self.rng), World()
        self.now, self.kills, self.cycles, self.refused = START, 0, 0, []

    def run(self, kills):
        """Run the campaign; return the faults that were found."""
        while self.kills < kills:
            self._live(0 if self.rng.random() < EARLY_SHARE else int(self.rng.integers(1, MOST_CYCLES)))
            if self.kills % 100 == 0:
                print(
                    f"{self.kills} kills, {len(self.client.accepted)} accepted, {self.cycles} cycles",
                    flush=True,
                )
        self._live(None)
        return [*self.world.faults, *self.refused, *self._check()]

    def _live(self, cycles):
        """Start the service; kill it after a number of cycles, or let it finish what is open."""
        ours, theirs = multiprocessing.Pipe()
        process = multiprocessing.get_context("fork").Process(
            target=serve, args=(self.path, self.site, theirs), daemon=True
        )
        process.start()
        theirs.close()
        timer = threading.Timer(self.rng.uniform(0.0, LONGEST_DELAY), os.kill, (process.pid, signal.SIGKILL))
        try:
            while cycles is None or cycles > 0:
                cycles = None if cycles is None else cycles - 1
                if not self._cycle(ours, is_last=cycles is None):
                    process.kill()
                    break
            else:
                timer.start()
                while True:
                    self._cycle(ours, is_last=False)
        except (EOFError, ConnectionError):
            self.kills += 1
        process.join()
        if process.exitcode != -signal.SIGKILL:
            self.world.faults.append(f"the service ended with exit code {process.exitcode}")

    def _cycle(self, pipe, is_last):
        self.now += CYCLE
        self.cycles += 1
        # An event is lost when the service dies with it: the robot then stands where it has arrived.
        event = self.robot.event(self.now)
        documents = list(self.client.waiting.values()) if is_last else self.client.documents()
        pipe.send((self.now, self.robot.inputs(self.now), event, documents))
        order, accepted, refused, objects = pipe.recv()
        self.world.publish(objects)
        self.client.answer(accepted)
        self.refused += refused
        self.robot.carry_out(order, self.now)
        self.is_idle = order is None and self.robot.is_docked and not self.client.waiting
        return not (is_last and self.is_idle and self.now % 600 < CYCLE and not self._open())

    def _open(self):
        journal = Journal(self.path, is_reader=True)
        try:
            return journal.restore().tasks
        finally:
            journal.close()

    def _check(self):
        journal = Journal(self.path)
        ended = {task.id: task for task in journal.ended_tasks(limit=10**6)}
        objects = journal.restore().objects
        log = [entry for _, entry in journal.log_after(0, 10**7)]
        ends = [entry.task for entry in log if entry.kind == "ended"]
        journal.close()
        self.completed = sum(task.status is TaskStatus.COMPLETED for task in ended.values())
        for name, document in self.client.accepted.items():
            if name not in ended:
                yield f"{name}: lost"
                continue
            if ends.count(name) != 1:
                yield f"{name}: ended {ends.count(name)} times"
            if ended[name].status is not TaskStatus.COMPLETED:
                yield f"{name}: {ended[name].status.value} ({ended[name].reason})"
            if document.get("category") != "deliver":
                continue
            item, target = document["description"]["object"], document["description"]["to"]
            deeds = [deed for deed in self.world.deeds if deed[2] == name]
            if deeds != [("picked up", item, name), ("set down", item, name, target)]:
                yield f"{name}: done as {deeds}"
        for name, state in objects.items():
            if self.world.states.get(name) != state:
                yield f"{name}: reported {state}, but is {self.world.states.get(name)}"
        yield from (
            f"{name}: ended, but was not accepted" for name in ended if name not in self.client.accepted
        )


def main():
    """Run the campaign; the exit code is 0 if no fault was found."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--kills", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    started = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        campaign = Campaign(Path(folder), options.seed)
        faults = campaign.run(options.kills)
        size = campaign.path.stat().st_size
    print(
        f"{campaign.kills} kills in {campaign.cycles} cycles, "
        f"{(campaign.now - START) / 3600.0:.1f} simulated hours, {time.monotonic() - started:.0f} s: "
        f"{len(campaign.client.accepted)} requests accepted, {campaign.completed} completed, "
        f"{len(campaign.world.deeds)} pick-ups and set-downs, journal {size // 1024} kB"
    )
    for fault in faults[:20]:
        print(f"fault: {fault}")
    print(f"{len(faults)} lost, doubled or reported wrongly")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
