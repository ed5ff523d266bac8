"""What interfaces are to Python code: the types of generated classes."""
