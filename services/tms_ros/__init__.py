"""The wrapper round rclpy, the only package that imports it."""
