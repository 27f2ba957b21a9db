# What the package's CMakeLists.txt calls of ament, for the test that configures it without ROS.
function(ament_package)
endfunction()
