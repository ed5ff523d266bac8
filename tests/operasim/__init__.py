"""A stand-in of OperaSim-PhysX, to test against without Unity: `python -m operasim --help`.

It speaks the ROS-TCP protocol as the simulator's connector does, with the machines, topics, rates and answers to
commands of its scenes. It shares no code with `services/`: what both would get wrong in the same way, no test finds.

The facts are those of OperaSim-PhysX main, commit 45d8a07 (2025-09-05), Unity 2022.3.4f1, ROS-TCP-Connector v0.7.1.
They were read in prefabs, scenes and scripts, none was measured in a running simulator.

Data: `machines/*.yaml` a prefab each, `scenes/*.yaml` which machines are where.
Plant, pure: `drive`, `front`, `tracks`, `base`, `machine`. Topics: `outputs`, `inputs`, `registration`, `world`.
Protocol: `cdr`, `messages`, `framing`, `connection`. Program: `control`, `program`.

Limits. Not read but assumed, hence options: true yaw rate of tracks, inertias, droop, kick of the base. The ground is
flat, machines neither tilt nor collide, there is no soil (PhysX has no topic of it either), cameras, lidar or services.
Joints are independent of each other. Sensors are exact, as the simulator's are.
"""
