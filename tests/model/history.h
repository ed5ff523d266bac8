/* The words of the history that is read, one a line of the file `history` in the verifier's folder; 0 after the last. */
static int history_words[20000];

static int history_word(int at)
{
	static int count = -1;
	if (count < 0) {
		FILE *file = fopen("history", "r");
		if (file == NULL) { perror("history"); exit(2); }
		for (count = 0; count < 19999 && fscanf(file, "%d", &history_words[count]) == 1; count++) {}
		fclose(file);
	}
	return at < count ? history_words[at] : 0;
}
