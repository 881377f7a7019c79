# SPDX-License-Identifier: MIT
# Writes OUT, the settings that are packaged: every one that PROGRAM (a list, an emulator may come first) knows,
# commented out so that a newer version's default holds until somebody sets another; but for the folders.
set(folders --set state.folder=/var/lib/dynslam --set recorder.folder=/var/lib/dynslam/recordings)
execute_process(COMMAND ${PROGRAM} check-config /dev/null ${folders} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "\n([a-z0-9_]+ = )" "\n#\\1" text "\n${text}")
string(REGEX REPLACE "\n#(folder = \"/var/lib/dynslam)" "\n\\1" text "${text}")
string(REGEX REPLACE "^\n" "" text "${text}")
file(WRITE "${OUT}" "# The robot's settings. Take away the # before one to set it, then: systemctl restart dynslam
# `dynslam check-config /etc/dynslam/dynslam.toml` says what is wrong with this file, and shows what is in force.

${text}")
