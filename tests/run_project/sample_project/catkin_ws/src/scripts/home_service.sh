#!/bin/sh
xterm -T "World" -e "source /opt/ros/kinetic/setup.bash; roslaunch turtlebot_gazebo turtlebot_world.launch world_file:=/home/workspace/catkin_ws/src/map/room.world" &
sleep 3
xterm -hold -e " source devel/setup.bash ; roslaunch turtlebot_gazebo amcl_demo.launch map_file:=/home/workspace/catkin_ws/src/map/room.yaml" &
sleep 3
xterm -e "rosrun rviz rviz -d /home/workspace/catkin_ws/src/rvizConfig/home_service.rviz" &
xterm -e "rosrun add_markers add_markers" &
xterm -e "rosrun pick_objects pick_objects" &
