"""The floor of a stop: a plain node that answers a message on one topic with a message on another."""

import os

import rclpy
from geometry_msgs.msg import Twist
from std_msgs.msg import Bool

os.setpriority(os.PRIO_PROCESS, 0, 0)  # like any program, whoever started it
rclpy.init()
node = rclpy.create_node("bench_relay")
zero = node.create_publisher(Twist, "/bench/zero", 1)
node.create_subscription(Bool, "/bench/press", lambda _: zero.publish(Twist()), 1)
rclpy.spin(node)
