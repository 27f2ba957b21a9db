# pluginlib's target, and its function that installs what describes a plugin.
add_library(pluginlib::pluginlib INTERFACE IMPORTED)

function(pluginlib_export_plugin_description_file category file)
  install(FILES ${file} DESTINATION share/${PROJECT_NAME})
endfunction()
