"""The stop drill: every kind of stop and fault, each compared with the true motion of a simulated machine."""
