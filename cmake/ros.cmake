# What the nodelets and the programs share (src/ros), and the nodelets.
