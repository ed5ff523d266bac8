"""`tms sensing replay`: plays a recorded bag into the sensing inputs."""
