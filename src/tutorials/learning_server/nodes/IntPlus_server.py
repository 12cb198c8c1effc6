#!/usr/bin/env python3
"""Add two integers: a server of this package's service type, learning_server/IntPlus."""

import rospy
from learning_server.srv import IntPlus, IntPlusResponse


def on_call(request):
    rospy.loginfo("request: %d + %d", request.a, request.b)
    return IntPlusResponse(request.a + request.b)


if __name__ == "__main__":
    rospy.init_node("IntPlus_server")
    rospy.Service("/Two_Int_Plus", IntPlus, on_call)
    rospy.loginfo("ready to add")
    rospy.spin()
