#include <cmath>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <visualization_msgs/Marker.h>

// Follows odometry, and sleeps in its callback while the object is picked up.
class Parcel
{
public:
  Parcel()
  {
    publisher_ = node_.advertise<visualization_msgs::Marker>("visualization_marker", 1);
    while (ros::ok() && publisher_.getNumSubscribers() < 1)
    {
      ROS_WARN_ONCE("Please create a subscriber to the marker");
      ros::WallDuration(0.1).sleep();
    }
    show(1.0, 0.5, visualization_msgs::Marker::ADD);
    subscriber_ = node_.subscribe("/odom", 1000, &Parcel::follow, this);
  }

private:
  void show(double x, double y, int action)
  {
    visualization_msgs::Marker marker;
    marker.header.frame_id = "/map";
    marker.header.stamp = ros::Time::now();
    marker.ns = "parcel";
    marker.type = visualization_msgs::Marker::CUBE;
    marker.action = action;
    marker.pose.position.x = x;
    marker.pose.position.y = y;
    marker.pose.orientation.w = 1.0;
    marker.scale.x = marker.scale.y = marker.scale.z = 0.2;
    marker.color.b = marker.color.a = 1.0;
    publisher_.publish(marker);
  }

  void follow(const nav_msgs::Odometry::ConstPtr& odometry)
  {
    const geometry_msgs::Point& position = odometry->pose.pose.position;
    const double goal_x = is_carried_ ? -0.5 : 1.0;
    if (is_delivered_ || std::hypot(position.x - goal_x, position.y - 0.5) > 0.35)
    {
      return;
    }
    if (!is_carried_)
    {
      ros::Duration(3.0).sleep();
      show(1.0, 0.5, visualization_msgs::Marker::DELETE);
      is_carried_ = true;
    }
    else
    {
      show(-0.5, 0.5, visualization_msgs::Marker::ADD);
      is_delivered_ = true;
    }
  }

  ros::NodeHandle node_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  bool is_carried_ = false;
  bool is_delivered_ = false;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "add_markers");
  Parcel parcel;
  ros::spin();
  return 0;
}
