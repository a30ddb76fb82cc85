# Installs the packages of the lock file in the working directory: cmake -DNPM=npm -P NpmInstall.cmake
# Without scripts of packages: esbuild's would only look for what is there.
execute_process(
  COMMAND ${NPM} ci --omit=dev --ignore-scripts --no-audit --no-fund --loglevel=error
  RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "npm could not install the packages of the viewer page. To build without "
    "`hexhex view`: cmake -DHEXHEX_BUILD_VIEWER=OFF")
endif()
