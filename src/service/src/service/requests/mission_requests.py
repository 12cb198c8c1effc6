"""Requests from a mission file."""

from typing import Any, Dict, List, Set

from pick_objects import Mission


def documents_of(mission: Mission, prefix: str) -> List[Dict[str, Any]]:
    """Return the deliveries of a mission as requests; those that others wait for come first.

    Args:
        mission: The mission.
        prefix: Begin of their ids, by which they are accepted once.
    """
    ids = {delivery.name: f"{prefix}-{number}" for number, delivery in enumerate(mission.deliveries, 1)}
    waiting = list(mission.deliveries)
    documents: List[Dict[str, Any]] = []
    done: Set[str] = set()
    while waiting:  # a mission has no cycles
        delivery = next(each for each in waiting if done.issuperset(each.after))
        waiting.remove(delivery)
        done.add(delivery.name)
        values = {"object": delivery.object_name, "from": delivery.source, "to": delivery.destination}
        description = {name: value for name, value in values.items() if value}
        unsourced = "fetch" if delivery.destination else "find"
        documents.append(
            {
                "id": ids[delivery.name],
                "category": "deliver" if delivery.source else unsourced,
                "description": description,
                "requester": mission.name[:200],
                "labels": [delivery.name[:200]],
                "after": [ids[name] for name in delivery.after],
            }
        )
    return documents
