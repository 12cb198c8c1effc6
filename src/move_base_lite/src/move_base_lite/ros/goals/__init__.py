"""Goals and plan requests: the action, the simple goal topic and the services."""
