"""Reading and replaying bags without a master."""
