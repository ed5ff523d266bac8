"""Reasons: errors between processes as codes with arguments, their texts, and the checks of data from outside.

This package needs no ROS and reads no files of a site.
"""
