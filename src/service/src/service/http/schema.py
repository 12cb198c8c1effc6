"""JSON schema of requests, for the published OpenAPI document; field names as in Open-RMF's task request."""

from typing import Any, Dict

from service.requests.parser import MAX_LABELS, MAX_PRIORITY, MAX_STEPS, MAX_TEXT, MAX_WAIT
from service.requests.request import DESCRIPTIONS

TEXT = {"type": "string", "maxLength": MAX_TEXT}
MILLIS = {"type": "integer", "description": "Unix time in milliseconds"}

REQUEST: Dict[str, Any] = {
    "title": "Task request",
    "type": "object",
    "additionalProperties": False,
    "properties": {
        "id": {**TEXT, "description": "chosen by the client: sent again, the request is accepted once"},
        "text": {**TEXT, "description": "deliver cup from kitchen to desk; instead of category, description"},
        "category": {"enum": list(DESCRIPTIONS)},
        "description": {
            "type": "object",
            "properties": {
                "object": TEXT,
                "from": TEXT,
                "to": TEXT,
                "place": TEXT,
                "places": {"type": "array", "items": TEXT, "maxItems": MAX_STEPS},
                "rounds": {"type": "integer", "minimum": 1, "maximum": MAX_STEPS},
                "seconds": {"type": "number", "minimum": 0, "maximum": MAX_WAIT},
            },
        },
        "priority": {
            "oneOf": [
                {"type": "integer", "minimum": 0, "maximum": MAX_PRIORITY},
                {"type": "object", "properties": {"value": {"type": "integer"}}, "required": ["value"]},
            ]
        },
        "requester": TEXT,
        "labels": {"type": "array", "items": TEXT, "maxItems": MAX_LABELS},
        "after": {"type": "array", "items": TEXT, "description": "ids of tasks to be done before"},
        "unix_millis_request_time": MILLIS,
        "unix_millis_earliest_start_time": MILLIS,
        "unix_millis_deadline": MILLIS,
        "not_before": {**TEXT, "description": "18:00, +30min or ISO 8601; instead of milliseconds"},
        "by": {**TEXT, "description": "deadline: 18:00, +30min or ISO 8601; instead of milliseconds"},
        "repeat": {**TEXT, "description": "cron expression in local time: 0 8 * * 1-5"},
    },
}
REQUEST_BODY = {"requestBody": {"required": True, "content": {"application/json": {"schema": REQUEST}}}}
