"""Gets a project ready to run: the copy of it that is built, and the file system that it sees."""
