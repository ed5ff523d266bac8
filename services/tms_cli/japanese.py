"""The Japanese of what `tms` prints, by its English; in the words of the console (tms_ur/static/words.js)."""

HEADINGS = {
    "Usage": "使い方", "Options": "オプション", "Commands": "コマンド", "Example:": "例:", "Examples:": "例:",
}  # fmt: skip

STATES = {
    "idle": "待機",
    "running": "実行中",
    "success": "成功",
    "failure": "失敗",
    "preparing": "準備中",
    "stopping": "停止処理中",
    "cancelled": "中止",
    "stop_unconfirmed": "停止未確認",
    "refused": "拒否",
    "interrupted": "中断",
    "abandoned": "打ち切り",
}

SAID = {
    # processes and the mesh
    "{name}: stopped": "{name}: 停止しました",
    "{name}: running": "{name}: 動いています",
    "{name} ready": "{name} 準備完了",
    "ready": "準備完了",
    "ready: {url}": "準備完了: {url}",
    "{folder}: closed {count} files to other users": "{folder}: 他の利用者が読めた {count} 件を非公開にしました",
    "mesh {name} started, state in {folder}": "メッシュ {name} を起動しました(状態の保存先 {folder})",
    "mesh {name} already runs, state in {folder}": "メッシュ {name} はすでに動いています(状態の保存先 {folder})",
    "mesh '{site}' ended": "メッシュ '{site}' を終了しました",
    "mesh '{site}' does not run": "メッシュ '{site}' は動いていません",
    " on PC '{pc}'": "(PC '{pc}')",
    "not in the site file any more": "サイトファイルにありません",
    "console and API: {url}": "コンソールと API: {url}",
    "`. .venv/bin/activate` puts the command tms on the path": "`. .venv/bin/activate` で tms コマンドが使えます",
    "the mesh goes on running: `make status` looks at it, `make down` ends it": (
        "メッシュは動き続けます: `make status` で確認、`make down` で終了"
    ),
    "{file}: right ({machines} machines, {processes} processes, {inputs} sensing inputs)": (
        "{file}: 正常(機械 {machines}、プロセス {processes}、センシング入力 {inputs})"
    ),
    "nothing was done, since nobody can answer here: use a terminal (`docker exec -it`), "
    "or --yes where the command has it": (
        "何も行っていません。ここでは確認に答えられません: 端末から(`docker exec -it`)、"
        "または --yes があるコマンドならそれを付けて実行してください"
    ),
    # runs
    "run {run}": "実行 {run}",
    "run {run}: {state}{reason}": "実行 {run}: {state}{reason}",
    "run {run} has begun: `tms events {run} --follow` shows it": (
        "実行 {run} を開始しました: `tms events {run} --follow` で経過を表示"
    ),
    "run {run} is being cancelled": "実行 {run} を中止しています",
    "run {run} is abandoned": "実行 {run} を打ち切りました",
    "run {run} was cancelled and its machines were seen to stand still": (
        "実行 {run} を中止し、機械の停止を確認しました"
    ),
    "the end of {run} is not stored yet: the disk of the scheduler's PC is slow or full": (
        "実行 {run} の結果はまだ保存されていません: スケジューラーの PC のディスクが遅いか、空きがありません"
    ),
    "{outcome} after {seconds:.1f} s, run {run}": "{outcome}({seconds:.1f} 秒)、実行 {run}",
    "history: tms events {run}": "記録: tms events {run}",
    "cancelling; waiting until the machines stand still (Ctrl-C again leaves)": (
        "中止しています。機械が止まるのを待っています(もう一度 Ctrl-C で待たずに終了)"
    ),
    "tms: the cancel did not get through: {error}; trying the action itself": (
        "tms: 中止が届きませんでした: {error}。アクションを直接中止します"
    ),
    "the scheduler did not take the task: see `tms logs tms:ts`": (
        "スケジューラがタスクを受け付けませんでした: `tms logs tms:ts` を確認してください"
    ),
    "no reason given: see `tms logs tms:ts`": "理由が示されていません: `tms logs tms:ts` を確認してください",
    "nothing has run yet: `tms run ID --wait` runs a task of `tms task list`": (
        "まだ実行はありません: `tms run ID --wait` で `tms task list` のタスクを実行できます"
    ),
    "{count} leaves have ended and are not repeated": "終わった動作 {count} 件は繰り返しません",
    "these were at work when the scheduler was lost, and begin again first:": (
        "スケジューラが失われたとき実行中だった次の動作を、最初にやり直します:"
    ),
    "no leaf was at work: it goes on with the next one": "実行中の動作はありませんでした: 次の動作から続けます",
    "flags and blackboard values are worked out anew from the tree's first node": (
        "フラグとブラックボードの値は、ツリーの先頭から計算し直します"
    ),
    "Resume it now?": "今すぐ再開しますか?",
    "answered {reply}: {text}": "{reply} と回答しました: {text}",
    ", until {time}": "(期限 {time})",
    "nobody asks anything": "確認待ちはありません",
    # machines
    "{machine}: stands, after {seconds:.2f} s and {angle:.3f} rad, {way:.2f} m; latched": (
        "{machine}: 停止を確認({seconds:.2f} 秒後、移動 {angle:.3f} rad、走行 {way:.2f} m)。停止を保持しています"
    ),
    "{machine}: STOP UNCONFIRMED: {detail}": "{machine}: 停止を確認できません: {detail}",
    "`tms rearm MACHINE` lets a machine move again": "`tms rearm 機械名` で再び動ける状態になります",
    "{machine} was stopped: {cause}": "{machine} の停止理由: {cause}",
    "Is it safe that {machine} moves again?": "周囲の安全を確認しましたか?{machine} が再び動ける状態になります",
    "{machine} is armed": "{machine} は運転可になりました",
    "{machine}: {who} drives by hand": "{machine}: {who} が手動運転中です",
    "{machine}: given back, seen to stand after {seconds:.2f} s": (
        "{machine}: 返却されました。{seconds:.2f} 秒後に静止を確認しました"
    ),
    "{machine} is a stand-in and was never armed on this PC: armed now": (
        "{machine} は模擬機で、この PC で初めて使うため、運転可にしました"
    ),
    "moving": "動作中",
    "standing": "停止",
    "not ready: {reason}": "準備未完了: {reason}",
    # tasks
    "task {task}": "タスク {task}",
    "task {task}, {model}: {text}": "タスク {task}、{model}: {text}",
    "no model": "機種なし",
    "task {task} removed": "タスク {task} を削除しました",
    "already stored as task {task}": "タスク {task} として登録済みです",
    "stored as task {task}: run it with `tms run {task} --wait`": (
        "タスク {task} として登録しました: `tms run {task} --wait` で実行できます"
    ),
    "none yet: `tms task add FILE` stores one": "まだありません: `tms task add FILE` で登録します",
    "error": "エラー",
    "warning": "警告",
    "can run": "実行できます",
    "its structure is right": "構造は正常です",
    "no scheduler answers: records and subtasks are unchecked": (
        "スケジューラが応答しません: レコードとサブタスクは点検していません"
    ),
    "records and subtasks are unchecked where the structure is wrong": (
        "構造に誤りがあるものは、レコードとサブタスクを点検していません"
    ),
    "{files} files: {ok} ok, {warnings} with warnings, {errors} with errors, {none} no task": (
        "{files} ファイル: 正常 {ok}、警告 {warnings}、エラー {errors}、タスクでない {none}"
    ),
    "{count} of {files} files checked": "{files} ファイル中 {count} 件を点検",
    "no task: {why}": "タスクではありません: {why}",
    "1 error": "エラー 1 件",
    "1 warning": "警告 1 件",
    "{count} errors": "エラー {count} 件",
    "{count} warnings": "警告 {count} 件",
    "ok": "正常",
    # records and sensing
    "records: {done}": "レコード: {done}",
    "{created} created, {changed} changed, {unchanged} unchanged": (
        "作成 {created}、変更 {changed}、変更なし {unchanged}"
    ),
    "{record}: {type}, {age}, from {source}": "{record}: {type}、{age}、書き込み元 {source}",
    " (at most {seconds:g} s)": "(上限 {seconds:g} 秒)",
    "{age} old": "{age} 前",
    "{kind} array": "{kind}の配列",
    "empty array": "空の配列",
    "true/false": "真偽",
    "integer": "整数",
    "decimal": "小数",
    "text": "文字列",
    "age unknown": "更新時刻不明",
    "unknown": "不明",
    "{record} created": "{record} を作成しました",
    "{record} changed": "{record} を変更しました",
    "{record} removed": "{record} を削除しました",
    "none: `tms param load FILE` or `tms param set MODEL/RECORD --create` makes records": (
        "ありません: `tms param load FILE` または `tms param set MODEL/RECORD --create` で作成します"
    ),
    "no changes since the database module keeps them": "記録が始まってからの変更はありません",
    "last refused: {reason}": "最後に拒否した理由: {reason}",
    # the database
    "{name} on {address}, schema {schema} (this program knows {newest})": (
        "{address} の {name}、形式の版 {schema}(このソフトは {newest} まで対応)"
    ),
    "Replace all of database {name} ({there})?": "データベース {name}({there})をすべて置き換えますか?",
    "restored into {name}: {report}": "{name} に復元しました: {report}",
    # audit
    "no command was given": "操作の記録はありません",
    "{count} entries are from before there was a chain: not checked": (
        "{count} 件は連鎖の導入前の記録のため、点検していません"
    ),
    "the chain begins at entry {first}: earlier ones were deleted": (
        "連鎖は記録 {first} から始まります。それより前は削除されています"
    ),
    "the console does not run on this PC: whether the last entries are missing is not seen here": (
        "この PC ではコンソールが動いていないため、最後の記録が欠けていても分かりません"
    ),
    "and {count} more": "ほか {count} 件",
    "intact: {count} entries, the last one is {last}": "異常なし: {count} 件、最後は記録 {last}",
    "NOT intact: {count} faults among {entries} entries": "異常あり: 記録 {entries} 件のうち {count} か所",
    "entries {first} to {last} are missing": "記録 {first} から {last} がありません",
    "entry {number} was changed": "記録 {number} が書き換えられています",
    "entry {number} does not follow the one before": "記録 {number} が前の記録につながっていません",
    "entry {number} has no hash: it was not written by this console": (
        "記録 {number} にハッシュがありません。このコンソールが書いたものではありません"
    ),
}

# What to do about an error, by its code (docs: tms_reason/errors.py).
NEXT = {
    "USAGE": "書き方は、コマンドに --help を付けると表示されます",
    "FAILED": "`tms status` と `tms logs` で原因を確認してください",
    "BAD_CONFIG": "示された設定を直し、`tms check` で点検してください",
    "BAD_TASK": "示された行を Groot で直し、`tms task check FILE` で点検してください",
    "BAD_COMMAND": "値を確認してください",
    "BAD_JOURNAL": "実行の記録が読めません。`tms runs` で別の実行を確認してください",
    "BAD_NAME": "名前を確認してください",
    "BAD_RECORD": "`tms param get MODEL/RECORD` で項目を確認し、`tms param set` で直してください",
    "BAD_TEXT": "制御文字を取り除いてください",
    "BAD_VALUE": "値の形式を確認してください(`tms param set --help`)",
    "BAD_TOKEN": "もう一度 `tms rearm MACHINE` をやり直してください",
    "AMBIGUOUS": "示された候補から 1 つを指定してください",
    "RUN_AMBIGUOUS": "実行の番号をもう少し長く指定してください",
    "BUSY": "使用中です。終わるのを待つか、`tms runs` で実行中のものを確認してください",
    "MACHINE_BUSY": "その機械は別の実行が使っています。終わるのを待つか、`tms cancel` で中止してください",
    "CONFLICT": "別の変更がありました。今の値を `tms param get` で確認してください",
    "DB_FAILED": "データベースを確認してください: `tms status`、`tms logs tms:db`",
    "STORE_CONFLICT": "別の書き込みと重なりました。もう一度実行してください",
    "STORE_DOWN": "データベースに接続できません: `tms status`、`tms logs tms:db` を確認してください",
    "STORE_FULL": "ディスクの空きを作ってください",
    "STORE_REFUSED": "データベースが拒否しました: `tms logs tms:db` を確認してください",
    "TOO_LARGE": "小さく分けてください",
    "LOCKED_RECORD": "実行中のレコードです。実行が終わってから変更してください",
    "STATIC_RECORD": "静的レコードです。実行が終わってから `tms param set` で変更してください",
    "STALE_RECORD": "値が古すぎます。センシングが動いているか `tms sensing` で確認してください",
    "RECORD_MISSING": "`tms param list` で確認し、`tms param set --create` で作成してください",
    "DRILL_RUNS": "終わるまで待ってください",
    "MESH_DOWN": "`tms up` でメッシュを起動してください",
    "SUPERVISOR": "`tms status` を確認し、必要なら `tms up` で起動してください",
    "NO_ACCESS": "示されたファイルを読み書きできる利用者で実行するか、別の場所を指定してください",
    "NO_ANSWER": "応答がありません。`tms status` でメッシュが動いているか確認してください",
    "NO_SERVER": "応答がありません。`tms status` でメッシュが動いているか確認してください",
    "NO_DISK": "スケジューラーの PC のディスクの空き容量を増やしてから、もう一度実行してください",
    "NO_PROCESS": "`tms ps` でプロセス名を確認してください",
    "NO_BROWSER": "示されたアドレスを別のブラウザーで開いてください",
    "NO_QUESTION": "`tms answer` で確認待ちを表示できます",
    "NO_RUN": "`tms runs` で実行を確認してください",
    "RUN_MISSING": "`tms runs` で実行を確認してください",
    "RUN_ENDED": "実行はすでに終わっています。`tms runs` で結果を確認してください",
    "NO_TASK": "`tms task list` でタスク番号を確認してください",
    "TASK_MISSING": "`tms task list` でタスク番号を確認してください",
    "NO_USER": "`tms user list` で利用者を確認してください",
    "NO_USERS": "サイトファイルに console.users を書くか、--file で指定してください",
    "SHORT_PASSWORD": "もっと長いパスワードにしてください",
    "NOT_ARMED": "機械は停止を保持しています。安全を確認して `tms rearm MACHINE` を実行してください",
    "TAKEN": "`tms give-back 機械名` で手動運転を終えてください",
    "NOT_TAKEN": "この機械は誰も預かっていません",
    "NOT_KEPT": "この PC のディスクの空きを確認してください",
    "HELD_BY_RUN": "実行を `tms cancel` で中止してから預かってください",
    "NOT_STOPPED": "機械は停止を保持していません。再起動許可は不要です",
    "PREFLIGHT": "示された点を直してください。警告だけなら --ignore-warnings で開始できます",
    "PROCESS_LOST": "`tms ps` と `tms logs` で終了したプロセスを確認してください",
    "STOP_UNCONFIRMED": "機械を目で確認し、必要なら機械の非常停止を押してください",
    "SCHEDULER_LOST": "機械を目で確認し、`tms status` と `tms logs tms:ts` を見てください",
    "FATAL": "プロセスが繰り返し終了しています。`tms logs` を確認してください",
    "STARTING": "起動中です。少し待ってからもう一度実行してください",
    "UNKNOWN": "`tms status` で確認してください",
    "BAD_ARCHIVE": "バックアップのファイルを確認してください(`tms db restore --help`)",
    "BAD_BAG": "記録(rosbag2)のファイルを確認してください",
    "BAD_STAMP": "記録の時刻を確認してください(`tms sensing replay --help`)",
    "BAD_START": "開始位置を記録の長さの中にしてください",
    "BAD_TERRAIN": "地形ファイルの形式を確認してください(`tms terrain add --help`)",
    "BAD_TOPIC": "トピック名を確認してください",
    "FILE_EXISTS": "別のファイル名を指定してください",
    "NOTHING_TO_PLAY": "記録のトピックと configs/sensing.yaml の入力を確認してください",
    "NOT_EMPTY": "データベースが空ではありません。置き換えるなら --drop を付けてください",
    "NOT_TMS": "このシステムのデータベースか、アドレスを確認してください",
    "NO_FILE": "ファイル名を確認してください",
    "NO_READER": "`tms ps` で tms:sp が動いているか確認してください",
    "RUN_ACTIVE": "実行が終わるのを待つか、`tms cancel` で中止してください",
    "STORE_NEWER": "データベースの版が新しすぎます。このソフトを更新してください",
    "TERRAIN_EXISTS": "登録済みの名前です。別の名前にするか `tms terrain rm` で削除してください",
    "TERRAIN_MISSING": "`tms terrain list` で名前を確認してください",
    "TWO_SOURCES": "同じトピックを出しているものを 1 つにしてください",
}
