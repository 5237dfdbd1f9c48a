/*
  The version of Lamella; CMakeLists.txt says the same.
*/
#ifndef LAMELLA_VERSION_H
#define LAMELLA_VERSION_H

#define LAMELLA_VERSION "0.1.0"

#endif
