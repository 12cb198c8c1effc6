"""The editor of plans in the browser: a page of its own with the drawing, checks by the Python core."""
