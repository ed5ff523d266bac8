// Health of MongoDB, and its first start as a replica set of one. Run by mongosh inside the container; the password
// comes from a file, so it is on no command line.
const password = fs.readFileSync("/run/secrets/mongodb_password", "utf8").trim();
const admin = db.getSiblingDB("admin");
admin.auth(process.env.MONGO_INITDB_ROOT_USERNAME, password);
try {
  rs.status();
} catch (error) {
  if (error.codeName !== "NotYetInitialized") throw error;
  rs.initiate({ _id: "rs0", members: [{ _id: 0, host: "127.0.0.1:27017" }] });
}
quit(db.hello().isWritablePrimary ? 0 : 1);
