#!/usr/bin/env bash
# tf2_ros 0.7.6 (Noetic; Debian 12): a message filter never passes a scan on if its transform arrives in another thread
# while the filter adds the scan.
#
# Guess:  a tf2_ros::MessageFilter passes each message on as soon as its transform is there, in whatever order the two come:
#         amcl and costmap_2d use it for each scan, while a thread of the transform listener fills the buffer.
# Is:     the filter asks the buffer for the transform first and puts the message into its list afterwards. A transform that
#         arrives in between is announced for a message that is not in the list yet, and never again. The message stays in
#         the filter until so many others wait that it is thrown away; no warning, and the count in the debug output stays
#         one higher from then on.
# Means:  a robot whose scans and odometry transforms have the same stamps and are sent together loses a scan now and then;
#         the official amcl then updates its filter with another one, so that two runs of a simulation part. Send the
#         transform first, and the scan when it has been processed.
#
# Takes the library of Debian 12 into a temporary folder, compiles a program with it and runs it, a minute; roscpp-dev and a
# compiler have to be installed. Exit code 1 if it behaves differently, 77 without them.
set -euo pipefail
version=0.7.6-1+b2
headers=/usr/include/ros/callback_queue.h
if [[ ! -f $headers ]] || ! command -v g++ >/dev/null; then
    echo "skipped: needs g++ and libroscpp-dev"
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf -- "$folder"' EXIT
cat >"$folder/filter.cpp" <<'CPP'
#include <ros/callback_queue.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/message_filter.h>

#include <atomic>
#include <iostream>
#include <thread>

constexpr int MOST_SCANS = 1000000;  // until one is kept
constexpr int FURTHER_SCANS = 200;   // after it, far fewer than the filter holds
constexpr int QUEUE_SIZE = 1000;
constexpr int PAUSES = 400;  // different delays of the transform

int main()
{
  ros::Time::init();
  tf2_ros::Buffer buffer;
  ros::CallbackQueue queue;
  tf2_ros::MessageFilter<sensor_msgs::LaserScan> filter(buffer, "odom", QUEUE_SIZE, &queue);
  int passed = 0;
  filter.registerCallback([&](const sensor_msgs::LaserScan::ConstPtr&) { ++passed; });

  std::atomic<int> begun{0}, transformed{0};
  std::atomic<bool> is_over{false};
  std::thread transforms([&] {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "odom";
    transform.child_frame_id = "laser";
    transform.transform.rotation.w = 1.0;
    for (int number = 1; !is_over; ++number)
    {
      while (begun < number && !is_over)
      {
      }
      for (volatile int pause = 0; pause < number % PAUSES; ++pause)
      {
      }
      transform.header.stamp = ros::Time(0.01 * number);
      buffer.setTransform(transform, "robot");
      transformed = number;
    }
  });
  int added = 0, kept = 0;
  while (added < MOST_SCANS)
  {
    sensor_msgs::LaserScan::Ptr scan(new sensor_msgs::LaserScan);
    scan->header.frame_id = "laser";
    scan->header.stamp = ros::Time(0.01 * ++added);
    begun = added;
    filter.add(scan);
    while (transformed < added)
    {
    }
    queue.callAvailable();
    if (added % FURTHER_SCANS == 0)
    {
      if (kept > 0 && added > passed)
      {
        break;
      }
      kept = added - passed;
    }
  }
  is_over = true;
  transforms.join();
  std::cout << "of " << added << " scans have not passed, " << FURTHER_SCANS << " scans later: " << added - passed << std::endl;
  return added == passed;
}
CPP
cd "$folder"
for package in libtf2-ros-dev libtf2-ros1d libtf2-dev libtf2-2d; do
    apt-get download -qq -o APT::Sandbox::User=root "$package=$version"
    dpkg --extract "$package"_*.deb root
done
libraries=$(dirname "$(find root -name 'libtf2_ros.so' | head -n 1)")
g++ -std=c++17 -O2 -isystem root/usr/include filter.cpp -o filter "-L$libraries" -ltf2_ros -ltf2 -lactionlib -lroscpp \
    -lrosconsole -lroscpp_serialization -lrostime -lmessage_filters -lboost_thread -lpthread
LD_LIBRARY_PATH=$PWD/$libraries ./filter || { echo "changed: tf2_ros $version" && exit 1; }
echo "as described: tf2_ros $version"
