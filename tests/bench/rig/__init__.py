"""What benchmark groups share: a mesh of their own, and bare rclpy processes as the floor."""
