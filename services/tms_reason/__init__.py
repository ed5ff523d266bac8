"""Why: the errors that cross a border, as codes with arguments, their texts, and the checks of data from outside.

No ROS, no files of a site.
"""
