# SPDX-License-Identifier: Apache-2.0
"""
Recordings as rosbag2 keeps them: a directory of MCAP files and a metadata.yaml.

Nothing in here imports rclpy; it knows the channels of the actuator, not its physics.

    definitions  the message types: definition texts and type hashes
    cdr          any message between bytes and a dictionary
    messages     the messages of this package, and fast encoders for the frequent ones
    tick         one observation row as messages
    topics       names, types and quality of service of what is recorded
    run_data     with what a recording was made
    opening      what stands in a file before its first chunk
    segment      one MCAP file being written
    metadata     the text of metadata.yaml
    limits       when a file is full, and when the disk is
    files        the files of a recording and the list of them
    writer       a recording being written
    memory       the last seconds of what would be recorded
    queue        a writer behind a thread and a bounded queue
    scan         one MCAP file being read, finished or not
    series       the messages of one topic as arrays
    rows         observation rows from the topics of the state
    reader       a recording as arrays over time
    labelled     a recording as xarray datasets with units
    export       a recording as CSV, Parquet or NetCDF
    chunks       the chunks of a file that may be damaged
    salvage      what is sound in one file, damaged or not
    proof        its topics and custom data, as far as they can be proved
    recovery     a new recording made of what is sound
"""
