# Install rules, exported targets and the pkg-config file.
