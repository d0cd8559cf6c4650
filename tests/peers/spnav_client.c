/* A client of spacenavd that asks what libspnav can ask and counts what it hears for some seconds. */
#include <spnav.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

int main(int argc, char** argv) {
  const int seconds = argc > 1 ? atoi(argv[1]) : 3;
  char name[64] = "";
  spnav_event event;
  int motions = 0;
  time_t end;
  if (spnav_open() != 0) {
    printf("cannot connect\n");
    return 1;
  }
  spnav_client_name("dubsar peers");
  spnav_dev_name(name, sizeof name);
  end = time(NULL) + seconds;
  while (time(NULL) < end) {
    if (spnav_poll_event(&event) == SPNAV_EVENT_MOTION)
      ++motions;
    else
      usleep(1000);
  }
  printf("protocol %d, \"%s\", %d axes, %d motions\n", spnav_protocol(), name, spnav_dev_axes(), motions);
  spnav_close();
  return spnav_protocol() == 1 && motions > 0 ? 0 : 1;
}
