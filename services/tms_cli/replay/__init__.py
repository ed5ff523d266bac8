"""`tms sensing replay`: a recorded bag into the sensing inputs."""
