# SPDX-License-Identifier: GPL-3.0-or-later
# What Doxygen reads of a file: the plain comment right after #pragma once is the file's description. Other text stays.
/^\/\/ SPDX-License-Identifier:/ { print ""; next }
/^#pragma once/ { print "/// \\file"; heading = 1; next }
heading && /^\/\// { sub(/^\/\//, "///"); print; next }
{ heading = 0; print }
