"""Loop closure: candidates, search, verification (``loop_closure``), place recognition and relocalization."""
