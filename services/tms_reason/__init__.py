"""Why: the errors that cross a border, as codes with arguments, and their texts. No ROS, no files of a site."""
