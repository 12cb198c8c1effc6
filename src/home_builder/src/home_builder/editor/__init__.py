"""The editor of plans in the browser: a page with the drawing, and checks by the Python core."""
