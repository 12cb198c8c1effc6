"""Loop closure: candidates, search, verification, place recognition and relocalization."""
