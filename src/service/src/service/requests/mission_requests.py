"""Requests from a mission file."""

from typing import Any, Dict, List

from pick_objects import Mission
from service.errors import RequestError


def documents_of(mission: Mission, prefix: str = "") -> List[Dict[str, Any]]:
    """Return the deliveries of a mission as requests, in their order.

    Args:
        mission: The mission.
        prefix: Begin of their ids, by which they are accepted once; empty: they get new ids.

    Raises:
        RequestError: If it has what requests do not have.
    """
    waiting = [delivery.name for delivery in mission.deliveries if delivery.after]
    if waiting:
        raise RequestError([f"{mission.name}: {waiting[0]}: after is not supported by the service"])
    documents: List[Dict[str, Any]] = []
    for number, delivery in enumerate(mission.deliveries, 1):
        description = {"object": delivery.object_name, "from": delivery.source, "to": delivery.destination}
        document: Dict[str, Any] = {
            "category": "deliver",
            "description": description,
            "requester": mission.name[:200],
            "labels": [delivery.name[:200]],
        }
        if prefix:
            document["id"] = f"{prefix}-{number}"
        documents.append(document)
    return documents
