/* The host agent: it stops a machine in place of its lost gateway, and hands on a press that a gateway did not remember. */

#define press_due(m) (host_press[m] && !shown[m] && !signal[m])
#ifdef PRESS_FORGOTTEN_EARLY
#define press_kept(m) true
#else
#define press_kept(m) (!note_armed[m]) /* a second later the disk has it, or the gateway is gone */
#endif

proctype Host(byte m) {
end:	do
	:: atomic { host == UP && gateway[m] != UP && !duty[m] ->
		printf("the host agent stands in for gateway %d\n", m);
		duty[m] = 1; host_cancels[m] = 1 }
	:: atomic { host == UP && duty[m] && at_server[m] != 0 && !host_cancels[m] && sick[m] != DEAF -> host_cancels[m] = 1 }
	/* a press is handed on before the word that the host agent no longer commands the machine: it is older than the restart */
	:: atomic { host == UP && duty[m] && gateway[m] == UP && !press_due(m) && !host_cancels[m] ->
		printf("the host agent sees gateway %d back\n", m);
		duty[m] = 0; away[m] = 0 }
#ifndef PRESS_NOT_HANDED_ON
	:: atomic { host == UP && gateway[m] == UP && press_due(m) && see(HANDED_ON, m, 0) -> seen;
		printf("the host agent hands a press on to gateway %d\n", m);
		hear_press(m) }
#endif
	:: atomic { host == UP && host_press[m] && gateway[m] == UP && shown[m] && press_kept(m) -> host_press[m] = 0 }
	od
}
