"""A yard of many machines for benchmarks: real gateways, stand-ins that only take goals and stand still."""
