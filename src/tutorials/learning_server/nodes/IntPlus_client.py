#!/usr/bin/env python3
"""Request a sum: a client of the service /Two_Int_Plus.

IntPlus_client.py A B
"""

import sys

import rospy
from learning_server.srv import IntPlus


def plus(a, b):
    rospy.wait_for_service("/Two_Int_Plus", timeout=10.0)
    return rospy.ServiceProxy("/Two_Int_Plus", IntPlus)(a, b).result


if __name__ == "__main__":
    rospy.init_node("IntPlus_client")
    try:
        a, b = map(int, rospy.myargv()[1:] or (5, 6))
        rospy.loginfo("%d + %d = %d", a, b, plus(a, b))
    except (rospy.ServiceException, rospy.ROSException, ValueError) as error:
        sys.exit(f"no sum: {error}")
