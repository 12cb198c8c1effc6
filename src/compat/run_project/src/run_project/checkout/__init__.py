"""Reads a project as it was checked out: what kind of folder it is, and which paths it counts on."""
