// Where pluginlib would register the class, the test makes one.
#pragma once

#define PLUGINLIB_EXPORT_CLASS(derived, base) \
  base* makePlugin() \
  { \
    return new derived; \
  }
